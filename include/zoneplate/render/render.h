#pragma once

#include <memory>
#include <optional>

#include "zoneplate/base/api.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/raster/types/raster_capacity.h"
#include "zoneplate/raster/types/stage_times.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/render/method.h"
#include "zoneplate/scene/scene.h"

namespace ZONEPLATE_API zoneplate {

class PreparedScene;

/// A part of the picture, in its pixels.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;  ///< pixels; (x, y) is the top-left one of the crop
};

/// Which triangle owns a sample that lies exactly on an edge.
enum class EdgeRule {
  TopLeft,  ///< a sample on a shared edge belongs to exactly one triangle
  Inside,   ///< for teaching: every triangle owns its edges
};

/// How hidden surfaces are removed.
enum class Visibility {
  ZBuffer,  ///< the nearest surface at each sample
  Painter,  ///< for teaching: triangles sorted by their mean depth, far first, no depth test
};

/// A scene as it is at some time, and the camera then. Of the scene, meshes and instances are looked at.
struct Moment {
  std::shared_ptr<const Scene> scene;  ///< its meshes and instances correspond to those of the rendered scene
  Camera camera;                       ///< its pose at the same time
};

/// How a scene becomes a frame; what does not depend on an antialiasing method.
struct RenderOptions {
  int width = 800, height = 600;                ///< pixels of the whole picture, 1 to 32768
  std::optional<Crop> crop;                     ///< the frame has the crop's size and the whole picture's bits
  EdgeRule edge_rule = EdgeRule::TopLeft;       ///< TopLeft, except for teaching
  Visibility visibility = Visibility::ZBuffer;  ///< ZBuffer, except for teaching
  bool cull_back_faces = true;                  ///< of single-sided materials
  int anisotropy = 1;  ///< texture probes along a footprint, for all samplers that blend levels; at most 16
  bool sample_footprint =
      true;  ///< at rate *sample*, choose texture levels for the sample's footprint, not the pixel's
  float point_size = 1, line_width = 1;  ///< pixels
  RasterCapacity capacity;               ///< memory for time; no bit of a picture depends on it
  DisplayOptions display;                ///< from linear light to display-referred colour
  std::optional<Moment> last;            ///< what Frame::motion is counted from; none: nothing moves
  std::optional<Moment> next;            ///< what Frame::flow leads to
};

/// Where time went and how much was done.
struct RenderCounts {
  double prepare_ms = 0;               ///< setup of the draws, materials and lights of the frame
  double geometry_ms = 0;              ///< from vertices to triangles in tiles
  double tiles_ms = 0;                 ///< visibility, shading, blending and output
  double resolve_ms = 0;               ///< the method's resolve, where the tiles have not done it
  double display_ms = 0;               ///< tone mapping, encoding and quantization outside the tiles
  double filter_ms = 0;                ///< the method's post-process filter
  StageTimes stages;                   ///< of geometry and tiles
  std::uint64_t vertices = 0;          ///< of all draws
  std::uint64_t triangles = 0;         ///< given
  std::uint64_t triangles_set_up = 0;  ///< after culling and clipping
  std::uint64_t shaded = 0;            ///< points shaded
  std::uint64_t geometric = 0;         ///< points of which only geometry or data planes were evaluated, without light
};

/// Renders one frame of a scene by a request, on the processor and the threads of the innermost `with_threads`.
/// Renderer (render/renderer.h) renders a method with all of its rounds.
///
/// Exact     the same bits for any number of threads and any instruction set; triangle order does not matter (equal depths: the
///           earlier triangle wins).
/// Errors    those of Backend::render.
Frame render(const PreparedScene& scene, const Camera& camera, const Request& request, const RenderOptions& options,
             RenderCounts* counts = nullptr);

}  // namespace zoneplate
