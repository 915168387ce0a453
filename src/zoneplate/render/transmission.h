// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "zoneplate/math/mat.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/shade/backdrop/backdrop.h"
#include "zoneplate/shade/cast/ground.h"
#include "zoneplate/shade/surface/surface.h"

namespace zoneplate {

/// The images of what is behind transmissive surfaces, which they refract; none where no draw transmits.
///
/// Transmissive draws whose extents along the view direction overlap form a layer, which does not see itself. Its image
/// holds the opaque and alpha-tested scene, the ground, the layers behind it, the blended draws that lie wholly behind
/// it, and the environment if that is the background. There are at most max_transmissive_layers: the layers nearest to
/// each other are joined.
///
/// The whole image is drawn, with four samples a pixel, so that a crop shows the same and silhouettes behind glass are
/// smooth under every method.
///
/// Cost      an image of the scene for each layer.
/// Errors    OutOfMemory.
std::optional<Backdrop> make_backdrop(const PreparedScene& scene, ViewUniforms view, std::span<const Draw> draws,
                                      const Ground* ground, const Camera& camera, const float4x4& clip_from_world,
                                      const RasterRules& rules, const RenderOptions& options, RasterMemory& memory);

constexpr int max_transmissive_layers = 4;

}  // namespace zoneplate
