// SPDX-License-Identifier: Apache-2.0
// FidelityFX Super Resolution 2.2: accumulates jittered frames of fewer pixels in an image of the full size. History is
// reprojected by motion, dropped where surfaces were hidden, clamped to the colours around, and kept where thin
// features are locked (fsr2_core.h).
//
// Without reactive masks, as an engine that gives none: colours that change without motion, of transparent surfaces or
// of moving light, arrive late. Weaknesses: the automatic exposure follows the top left of the frame, as AMD's does; a
// thin feature in motion loses its lock and is drawn by the samples of one frame; each pixel has one depth and one
// motion, so that surfaces behind transparent ones smear.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: AMD, FidelityFX-FSR2 2.2.1, 2022.
#include "zoneplate/upscale/fsr/method.h"
#include "zoneplate/upscale/fsr2/fsr2_core.h"

namespace zoneplate::upscale {
namespace {

constexpr std::string_view switches[] = {"off", "on"};
constexpr Param params[] = {
    scale_param,
    fsr_bias_param,
    real_param("sharpness", "of the sharpening pass; 0: none", 0, 0, 1),
    real_param("exposure", "factor of the colours; 0: from the mean luminance", 0, 0, 1e6),
    {.name = "locks", .meaning = "thin features keep their history", .value = 1, .names = switches},
    {.name = "rectify", .meaning = "history is clamped to the colours around", .value = 1, .names = switches},
    {.name = "clip", .meaning = "surfaces that were hidden drop their history", .value = 1, .names = switches},
    {.name = "lanczos",
     .meaning = "Lanczos' kernels; off: bilinear history, and a kernel without negative lobes",
     .value = 1,
     .names = switches}};

}  // namespace

Upscaler fsr2() {
  return {.name = "fsr2",
          .summary = "FidelityFX Super Resolution 2.2: jittered frames, accumulated with locks and depth tests",
          .source = "AMD 2022, FidelityFX-FSR2 2.2.1",
          .params = params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const auto is_on = [&](std::string_view name) { return s.chosen(name) == "on"; };
            const auto sharpness = static_cast<float>(s.number("sharpness"));
            return std::make_unique<FsrMethod<Fsr2, Fsr2Options>>(
                "fsr2", s,
                Fsr2Options{.sharpens = sharpness > 0,
                            .sharpness = sharpness,
                            .locks = is_on("locks"),
                            .rectifies = is_on("rectify"),
                            .clips_depth = is_on("clip"),
                            .has_lanczos = is_on("lanczos"),
                            .exposure = static_cast<float>(s.number("exposure"))});
          }};
}

}  // namespace zoneplate::upscale
