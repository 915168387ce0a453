// SPDX-License-Identifier: Apache-2.0
// Learned super-sampling: `taau` at scale 2, of which a network of 14,888 parameters corrects, for each output pixel,
// the weights of nine samples and how much their mean counts, how many of the history's samples count and how many of
// those that `taau` drops, how far history is clamped, and which of two motions it follows: that of the nearest
// surface, or that of the pixel's own. Corrections of 0 are `taau`. A table of filters of 3 × 3 pixels (upscale/table)
// then improves the image, whose history it leaves. Both make no colours: an image is a weighted mean of the frame's
// samples and the history.
//
// The network reads what `taau` knows of each frame pixel (learned_rows_lanes.h): colours, extremes, motion, depth, and
// the history of its output pixels beside the frame's samples. It needs no ids, and so serves the frames of other
// renderers. Weaknesses: it is trained for scale 2 alone, on generated scenes without transparent surfaces, shadows and
// reflections (train/README.md).
//
// At scale 1 the image is the mean of 2 × 2 pixels of one of twice the size.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: the kernels that networks predict are of Bako et al., Kernel-Predicting Convolutional Networks for Denoising
// Monte Carlo Renderings, SIGGRAPH 2017; history and its parameters of learned temporal upscalers, as Arm's NSS.
#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/learned/learned_mean.h"
#include "zoneplate/upscale/taau/taau_method.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr int scales[] = {1, 2};
constexpr Param params[] = {{.name = scale_param.name, .meaning = scale_param.meaning, .value = 2, .choices = scales},
                            bias_param(-1)};

/// FilteredLearned of images of the frames' size: its pixels are means of 2 × 2 of one that has twice the size.
class LearnedBox {
 public:
  static constexpr int settling_periods = FilteredLearned::settling_periods, grain = 2;

  LearnedBox(int width, int height) : mean_(grain * width, grain * height) {}

  LinearImage accumulate(const TaauInput& frame) {
    const LinearImage fine = mean_.accumulate(frame);
    LinearImage out(fine.width() / grain, fine.height() / grain);
    parallel_ranges(static_cast<std::size_t>(out.height()), 16, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
        for (int x = 0; x < out.width(); ++x)
          out(x, y) =
              (fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y) + fine(2 * x, 2 * y + 1) + fine(2 * x + 1, 2 * y + 1)) *
              0.25f;
    });
    return out;
  }

 private:
  FilteredLearned mean_;
};

template <class Core>
class LearnedMethod : public TaauMethod<Core> {
 public:
  LearnedMethod(int scale, double bias) : TaauMethod<Core>("learned", scale, bias), scale_(scale) {}

  Request request(const FrameContext& context) override {
    const ImageExtent small = zoneplate::frame_size(context.image, scale_),
                      frame = upscale::frame_size(context, scale_);
    if (frame.width != small.width || frame.height != small.height)
      throw Error(ErrorKind::Usage,
                  fmt::format("learned makes images of {}the frames' size: for {} x {} pixels it needs frames of "
                              "{} x {}, not of {} x {}",
                              scale_ == 1 ? "" : "twice ", context.image.width, context.image.height, small.width,
                              small.height, frame.width, frame.height));
    return TaauMethod<Core>::request(context);
  }

 private:
  int scale_;
};

}  // namespace

Upscaler learned() {
  return {.name = "learned",
          .summary = "taau, whose weights a small network corrects per pixel; scale 1 or 2",
          .source = "Zoneplate, train/",
          .params = params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const double bias = s.number("bias");
            if (s.integer("scale") == 1) return std::make_unique<LearnedMethod<LearnedBox>>(1, bias);
            return std::make_unique<LearnedMethod<FilteredLearned>>(2, bias);
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
