// SPDX-License-Identifier: Apache-2.0
// Learned super-sampling: `taau` at scale 2, of which a network of 14,888 parameters corrects, for each output pixel,
// the weights of nine samples and how much their mean counts, how many of the history's samples count and how many of
// those that `taau` drops, how far history is clamped, and which of two motions it follows: that of the nearest
// surface, or that of the pixel's own. It makes no colours: an image is a weighted mean of the frame's samples and the
// history. Corrections of 0 are `taau`.
//
// The network reads what `taau` knows of each frame pixel (learned_rows_lanes.h): colours, extremes, motion, depth, and
// the history of its output pixels beside the frame's samples. It needs no ids, and so serves the frames of other
// renderers. Weaknesses: it is trained for scale 2 alone, on generated scenes without transparent surfaces, shadows and
// reflections (train/README.md).
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: the kernels that networks predict are of Bako et al., Kernel-Predicting Convolutional Networks for Denoising
// Monte Carlo Renderings, SIGGRAPH 2017; history and its parameters of learned temporal upscalers, as Arm's NSS.
#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/upscale/learned/learned_mean.h"
#include "zoneplate/upscale/taau/taau_method.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr int scales[] = {2};
constexpr Param params[] = {{.name = scale_param.name, .meaning = scale_param.meaning, .value = 2, .choices = scales},
                            bias_param(-1)};

class LearnedMethod : public TaauMethod<LearnedMean> {
 public:
  explicit LearnedMethod(double bias) : TaauMethod("learned", 2, bias) {}

  Request request(const FrameContext& context) override {
    const ImageExtent half = zoneplate::frame_size(context.image, 2), frame = upscale::frame_size(context, 2);
    if (frame.width != half.width || frame.height != half.height)
      throw Error(
          ErrorKind::Usage,
          fmt::format("learned makes images of twice the frames' size: for {} x {} pixels it needs frames of "
                      "{} x {}, not of {} x {}",
                      context.image.width, context.image.height, half.width, half.height, frame.width, frame.height));
    return TaauMethod::request(context);
  }
};

}  // namespace

Upscaler learned() {
  return {.name = "learned",
          .summary = "taau, whose weights a small network corrects per pixel; scale 2",
          .source = "Zoneplate, train/",
          .params = params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<LearnedMethod>(s.number("bias"));
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
