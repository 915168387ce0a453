// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/image/rgb.h"
#include "zoneplate/render/method.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate {

/// The part of an image's surfaces from which on it counts as clipped.
inline constexpr double min_white = 0.25;

/// The image that light is metered in: linear, of the whole view, at most 256 pixels along the longer side.
///
/// Requires  the renderer's method, `none`, takes one sample per pixel.
LinearImage metered_image(Renderer& renderer, const Camera& camera, RenderOptions options);

/// True if surfaces are well above white at an exposure, where `metered` is auto_exposure of the metered image: not of
/// those that are just white.
bool is_well_above_white(float exposure, float metered);

/// How the lights of a file are dimmed.
struct LightDimming {
  float factor = 1;  ///< of every light's intensity
  double white = 0;  ///< the part of the surfaces that would be clipped to white; 0 if the factor is 1
};

/// The factor that brings the lights of a scene that needs a fill light (Scene::needs_fill_light) to the brightness of
/// auto_exposure, where they would clip the luminance of the part min_white of its surfaces or more; 1 for all
/// others. What the fill light and emission make of a picture does not count.
///
/// It is a property of the scene, so that views of it are alike: the least of the factors of the whole-scene view and
/// of the scene's first camera, 256 pixels wide and high. Exporters write thousands of candelas and lux. The fill light
/// and emission, which an exposure would make black, keep their brightness.
/// Requires  the scene is lit by make_lighting without an environment, an intensity or a source of the options.
LightDimming dimming_of(const PreparedScene& scene, std::unique_ptr<Resolver> none);

/// The scene with the intensities of its lights multiplied by the factor.
PreparedScene dimmed(PreparedScene scene, float factor);

}  // namespace zoneplate
