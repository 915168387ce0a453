// SPDX-License-Identifier: Apache-2.0
// `oracle-taa` from frames of fewer pixels than the image: the history of every object in every pixel of the image, of
// samples that are shaded at the frames' resolution. Visibility is exact at the image's resolution, by further passes
// without shading. It bounds what a temporal upscaler can make of the same shaded samples.
//
// Weaknesses: those of `oracle-taa`; and an object that appears has no sample in most of its pixels, which get the mean
// of its samples around.
#include "zoneplate/antialias/temporal/surface_history.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

class OracleTaau : public antialias::SurfaceHistory {
 public:
  using SurfaceHistory::SurfaceHistory;

  Request request(const FrameContext& context) override {
    Request request = SurfaceHistory::request(context);
    if (request.frame) crop_ = context.image.crop;
    return request;
  }
  LinearImage resolve(Frame& frame) override { return cropped(SurfaceHistory::resolve(frame), crop_); }

 private:
  std::optional<Crop> crop_;  ///< of an image that the renderer does not cut out
};

constexpr Param oracle_params[] = {
    scale_param,
    {.name = "most", .meaning = "frames of which the history is a mean, at most", .value = 64, .low = 2, .high = 4096},
    {.name = "coverage", .meaning = "visibility samples per pixel of the image", .value = 16, .low = 1, .high = 64}};

}  // namespace

Upscaler oracle_taau() {
  return {.name = "oracle-taau",
          .summary = "jittered frames, accumulated by object with exact visibility of the whole image's pixels",
          .source = "Zoneplate",
          .params = oracle_params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<OracleTaau>(antialias::SurfaceHistory::Options{
                .most = s.integer("most"), .coverage = s.integer("coverage"), .scale = s.number("scale")});
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
