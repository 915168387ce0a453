// SPDX-License-Identifier: Apache-2.0
// Temporal antialiasing that upsamples (TAAU), as in Unreal Engine 4.19 to 4.27: the parts of `taa:preset=karis` at the
// output's resolution. An output pixel's current colour is the mean of the frame's 3 × 3 samples around it, by a kernel
// of one output pixel's radius; the sum of the weights is the factor of the frame's share, so that a pixel far from
// every sample keeps its history. History is clamped to the range of the samples within 1.3 to 1.51 frame pixels.
//
// Left out: responsive materials, the flag that removes ghosts of moving objects before a background at rest, the wider
// kernel after rejection, which is of its supersampling mode, and dithering. Weaknesses: details of which a frame has
// no sample are clamped away, thin lines flicker; at 2 × a pixel's history is a mean of some 90 frames, so that after a
// cut the frame's own resolution stays visible for a second.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: Karis, High-Quality Temporal Supersampling, SIGGRAPH 2014 course; Unreal Engine 4.2x, TemporalAA.usf, pass
// MainUpsampling at high quality.
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "zoneplate/signal/samples.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/taau/taau_core.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

class TaauMethod : public Resolver {
 public:
  explicit TaauMethod(double scale) : scale_(scale), jitter_(halton_sequence(phases(scale))) {}

  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override {
    context_ = context;
    sample_ = sample_of(context, jitter_[static_cast<std::size_t>(context.index) % jitter_.size()]);
    Request request;
    request.samples = {sample_};
    request.planes.depth = request.planes.motion = true;
    request.frame = frame_size(context, scale_);
    request.footprint = 1 / static_cast<float>(scale_);
    request.settling_frames = 8 * static_cast<int>(jitter_.size());  // the first frame's share is then 6 %
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    const ImageExtent& image = context_.image;
    if (context_.is_first || !taau_) taau_.emplace(image.width, image.height);
    complete_background(frame, context_, sample_, std::numeric_limits<float>::infinity());
    const int width = frame.color.width(), height = frame.color.height();
    TaauInput input{.color = over_background(std::move(frame.color), frame.display, "taau"),
                    .nearness = std::move(frame.reversed_depth),
                    .motion_x = Plane<float>(width, height),
                    .motion_y = Plane<float>(width, height),
                    .jitter = {(128 - sample_.x) / 256.0f, (128 - sample_.y) / 256.0f},
                    .is_first = context_.is_first};
    std::ranges::transform(frame.motion.values(), input.motion_x.values().begin(), &float2::x);
    std::ranges::transform(frame.motion.values(), input.motion_y.values().begin(), &float2::y);
    return cropped(taau_->accumulate(input), image.crop);
  }

 private:
  /// 8 samples per output pixel.
  static int phases(double scale) { return std::max(static_cast<int>(8 * scale * scale), 1); }

  double scale_;
  SamplePattern jitter_;
  FrameContext context_;
  SamplePosition sample_;
  std::optional<Taau> taau_;
};

constexpr Param taau_params[] = {scale_param};

}  // namespace

Upscaler taau() {
  return {.name = "taau",
          .summary = "temporal antialiasing that upsamples: jittered frames, weighed by distance to the output pixels",
          .source = "Karis 2014; Unreal Engine 4, TemporalAA.usf, MainUpsampling",
          .params = taau_params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<TaauMethod>(s.number("scale"));
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
