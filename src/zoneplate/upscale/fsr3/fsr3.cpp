// SPDX-License-Identifier: Apache-2.0
// The upscaler of FidelityFX Super Resolution 3.1: accumulates jittered frames in an image of the full size. History is
// reprojected by motion, dropped where surfaces were hidden or their shading changes, clamped to the colours around,
// and kept where thin features are locked or where luma alternates (fsr3_core.h). Frame generation is no part of it.
//
// Against FSR 2: each pixel counts how much history it has, in thirds that a frame adds; the first frame after a
// disocclusion is a wide Gaussian, tone-mapped; shading is compared by sorted lumas of five pixels, at three levels;
// history is clamped to an ellipsoid; locks have a strength and last.
//
// Without reactive masks, as an engine that gives none. Weaknesses: automatic exposure treats frames darker than 1 as
// if they had the luminance 1 and follows the top left of the frame, as AMD's does; constants are in metres and in
// pixels of 3840 × 2160; history is never read from the outermost pixels, which repeat a part of their neighbours; near
// surfaces, up to 15 m away, have less tolerance for thin features; each pixel has one depth and one motion, so that
// surfaces behind transparent ones smear.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: AMD, FidelityFX SDK 1.1.4 (FSR 3.1.4), 2025.
#include "zoneplate/upscale/fsr/method.h"
#include "zoneplate/upscale/fsr3/fsr3_core.h"

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
    {.name = "shading", .meaning = "pixels whose light changes drop their history", .value = 1, .names = switches},
    real_param("velocity", "how much less history counts in motion", 1, 0, 1)};

}  // namespace

Upscaler fsr3() {
  return {.name = "fsr3",
          .summary = "FidelityFX Super Resolution 3.1: jittered frames, accumulated with tests of depth and shading",
          .source = "AMD 2025, FidelityFX SDK 1.1.4",
          .params = params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const auto is_on = [&](std::string_view name) { return s.chosen(name) == "on"; };
            const auto number = [&](std::string_view name) { return static_cast<float>(s.number(name)); };
            return std::make_unique<FsrMethod<Fsr3, Fsr3Options>>("fsr3", s,
                                                                  Fsr3Options{.sharpens = number("sharpness") > 0,
                                                                              .sharpness = number("sharpness"),
                                                                              .locks = is_on("locks"),
                                                                              .rectifies = is_on("rectify"),
                                                                              .clips_depth = is_on("clip"),
                                                                              .tests_shading = is_on("shading"),
                                                                              .velocity_factor = number("velocity"),
                                                                              .exposure = number("exposure")});
          }};
}

}  // namespace zoneplate::upscale
