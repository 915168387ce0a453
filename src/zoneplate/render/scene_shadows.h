// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/render/render.h"
#include "zoneplate/shade/cast/casters.h"
#include "zoneplate/shade/shadow/shadow_map.h"
#include "zoneplate/shade/shadow/shared_visibility.h"
#include "zoneplate/shade/shadow/traced_visibility.h"
#include "zoneplate/shade/surface/surface.h"

namespace zoneplate {

/// The lines of sight through the image: from origin + x origin_dx + y origin_dy along the same of direction; x and y
/// in pixels from the image's top-left corner.
struct LinesOfSight {
  float3 origin, origin_dx{0, 0, 0}, origin_dy{0, 0, 0};
  float3 direction, direction_dx{0, 0, 0}, direction_dy{0, 0, 0};

  LinesOfSight(const Camera& camera, const float4x4& clip_from_camera, const RenderOptions& options);
  Ray through_centre(PixelPosition pixel) const;
};

/// The shadow casters of a scene: their tree, which lasts as long as the scene's geometry, or the maps of a frame.
class SceneShadows {
 public:
  /// The visibility of a frame's lights; null where the options need none. It is valid until the next call, and as long
  /// as `view`.
  const LightVisibility* of_frame(const PreparedScene& prepared, const ViewUniforms& view, const LinesOfSight& lines,
                                  const RenderOptions& options);

 private:
  std::shared_ptr<const Scene> scene_;
  std::optional<Bvh> bvh_;
  std::optional<CasterOpacity> opacity_;
  std::optional<TracedVisibility> traced_;
  std::optional<SharedVisibility> shared_;
  std::optional<MappedVisibility> mapped_;
};

/// The maps of the lights, in their order, rendered by the rasterizer: one for each directional light and narrow spot
/// light, six for others.
std::vector<std::vector<ShadowMap>> make_shadow_maps(const PreparedScene& prepared, const std::vector<Light>& lights,
                                                     int size);

}  // namespace zoneplate
