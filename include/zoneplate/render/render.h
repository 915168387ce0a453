// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "zoneplate/edges/edge_options.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/raster/types/raster_rules.h"
#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/raster/types/stage_times.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/render/method.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/scene/texture_filter.h"
#include "zoneplate/shade/shadow/shadows.h"

#pragma GCC visibility push(default)
namespace zoneplate {

class PreparedScene;

/// The environment behind a scene's surfaces.
struct EnvironmentBackground {
  float blur = 0;  ///< 0: sharp; up to 1: as the surface of that roughness reflects it
};

/// A scene and its camera at one point in time. Only the scene's meshes and instances are used.
struct Moment {
  std::shared_ptr<const Scene>
      scene{};      ///< of the rendered scene at that time: instances correspond by object and part
  Camera camera{};  ///< its pose at the same time
};

/// The options of rendering that do not depend on the antialiasing method.
struct RenderOptions {
  int width = 800, height = 600;                ///< pixels of the whole image, 1 to 32768
  std::optional<Crop> crop{};                   ///< the frame has the crop's size and the bits of the whole image
  float aspect = 0;                             ///< width / height of the camera's view; 0: that of the image
  EdgeRule edge_rule = EdgeRule::TopLeft;       ///< TopLeft, except for teaching
  Visibility visibility = Visibility::ZBuffer;  ///< ZBuffer, except for teaching
  ShadingFrequency shading_frequency = ShadingFrequency::Fragment;  ///< Fragment, except for teaching
  bool cull_back_faces = true;                                      ///< of single-sided materials
  int anisotropy = 1;  ///< maximum texture probes along a footprint, for all samplers that blend mip levels; at most 16
  TextureFilter texture_filter{};                                 ///< of all textures; by default that of each sampler
  SpecularAntialiasing specular_aa = SpecularAntialiasing::None;  ///< of metallic-roughness materials
  LightComponent light_component = LightComponent::All;  ///< what the colours hold; All, except for light passes
  ShadowOptions shadows{};                               ///< of the lights; none by default
  OcclusionOptions occlusion{};                          ///< of the environment's light; none by default
  /// Shadow requires shadows or occlusion. It moves the near and far planes, which may change data passes by rounding.
  GroundKind ground = GroundKind::None;
  EdgeOptions edges{};           ///< lines over the image of Renderer; data passes have none
  bool sample_footprint = true;  ///< at rate *sample*, choose mip levels by the sample's footprint, not the pixel's
  float point_size = 1, line_width = 1;               ///< pixels
  RasterCapacity capacity{};                          ///< trades memory for time; does not change any bit of the image
  std::optional<EnvironmentBackground> background{};  ///< none: that of `display`
  DisplayOptions display{};                           ///< from linear light to display-referred colour
  /// Before a transparent background, transmissive surfaces keep their coverage as alpha and transmit black where
  /// nothing is behind them; otherwise their alpha is 1 - the part of light that passes.
  bool opaque_glass = false;
  std::optional<Moment> last{};  ///< the moment from which Frame::motion is measured; none: no motion
  std::optional<Moment> next{};  ///< the moment to which Frame::flow leads
  /// Called by any thread while tiles are drawn, with the fraction of them that is complete; a method that draws in
  /// several rounds begins each at 0.
  std::function<void(double)> progress{};
};

/// Width / height of the camera's view.
inline float aspect_of(const RenderOptions& o) {
  return o.aspect > 0 ? o.aspect : static_cast<float>(o.width) / static_cast<float>(o.height);
}

/// Whether rays to the lights or to the environment are traced.
inline bool has_visibility(const RenderOptions& o) {
  return o.shadows.method != ShadowMethod::None || o.occlusion.samples > 0;
}

/// Times and counts of the work of a frame.
struct RenderCounts {
  double prepare_ms = 0;               ///< setup of the draws, materials and lights of the frame
  double geometry_ms = 0;              ///< from vertices to triangles in tiles
  double tiles_ms = 0;                 ///< visibility, shading, blending and output
  double resolve_ms = 0;               ///< the method's resolve, unless the tiles did it
  double display_ms = 0;               ///< tone mapping, encoding and quantization outside the tiles
  double filter_ms = 0;                ///< the method's post-process filter
  StageTimes stages{};                 ///< of geometry and tiles
  std::uint64_t vertices = 0;          ///< of all draws
  std::uint64_t triangles = 0;         ///< of all draws
  std::uint64_t triangles_set_up = 0;  ///< after culling and clipping
  std::uint64_t shaded = 0;            ///< shaded fragments
  std::uint64_t geometric = 0;         ///< fragments whose geometry or data were evaluated without lighting
};

/// Renders one frame of a scene by a request, on the processor and the threads of the innermost `with_threads`.
/// Renderer (render/renderer.h) renders by a method, with all of the method's rounds.
///
/// Exact     the same bits for any number of threads and any instruction set; triangle order does not matter (equal depths: the
///           earlier triangle wins).
/// Errors    those of Backend::render.
Frame render(const PreparedScene& scene, const Camera& camera, const Request& request, const RenderOptions& options,
             RenderCounts* counts = nullptr);

}  // namespace zoneplate
#pragma GCC visibility pop
