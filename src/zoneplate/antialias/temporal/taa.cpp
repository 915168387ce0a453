// SPDX-License-Identifier: Apache-2.0
// Temporal antialiasing: every frame shades one sample per pixel, at another position of the pixel. The result of the
// last frame, moved along with the surfaces, supplies the samples of earlier frames.
//
// The parts (parts.h) are those of the published methods; a preset has the parts, and the constants, of one source.
// Weaknesses: history that moves by fractions of a pixel is filtered in every frame, which blurs it; where history
// belongs to another surface or to other light, it leaves ghosts, or a test drops it and the pixel has one sample
// again; details thinner than a pixel, which most frames miss, are clipped away and flicker.
//
// Motion is that of the surface point of the pixel's sample, without jitter; of the background, that of the camera. A
// crop renders the whole image, since motion may bring any pixel into it.
#include "zoneplate/antialias/temporal/accumulation.h"

namespace zoneplate::antialias {
namespace {

constexpr std::string_view variants[] = {"preset=karis", "preset=inside",     "preset=salvi",
                                         "preset=three", "preset=playcanvas", "preset=bevy"};

}  // namespace

Method taa() {
  return {.name = "taa",
          .summary = "one jittered sample per frame, averaged with the reprojected and validated history",
          .source = "Karis 2014; presets: INSIDE, Salvi 2016, three.js, PlayCanvas, Bevy",
          .params = temporal_params(),
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<TemporalAccumulation>(temporal_options(s));
          },
          .variants = variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
