#pragma once

#include <optional>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/raster/types/room.h"
#include "zoneplate/raster/types/stage_times.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/render/method.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

class TextureSet;
class InterleavedVertices;
struct RasterMemory;

/// A part of the picture, in its pixels.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
};

enum class EdgeRule {
  TopLeft,  ///< a sample on a shared edge belongs to exactly one triangle
  Inside,   ///< for teaching: every triangle owns its edges
};

enum class Visibility {
  ZBuffer,
  Painter,  ///< for teaching: triangles sorted by their mean depth, far first, no depth test
};

/// A scene as it is at some time, and the camera then.
struct Moment {
  const Scene* scene = nullptr;
  Camera camera;
};

/// How a scene becomes a frame; what does not depend on an antialiasing method.
struct RenderOptions {
  int width = 800, height = 600;
  std::optional<Crop> crop;  ///< the frame has the crop's size and the whole picture's bits
  EdgeRule edge_rule = EdgeRule::TopLeft;
  Visibility visibility = Visibility::ZBuffer;
  bool cull_back_faces = true;  ///< of single-sided materials
  float3 environment{0, 0, 0};  ///< radiance of a constant environment
  bool raw_colors = false;      ///< images are not decoded from sRGB
  int anisotropy = 1;           ///< texture probes along a footprint, for all samplers that blend levels; at most 16
  bool sample_footprint =
      true;  ///< at rate *sample*, choose texture levels for the sample's footprint, not the pixel's
  float point_size = 1, line_width = 1;  ///< pixels
  Isa isa = current_isa();
  RasterRoom room;  ///< memory for time; no bit of a picture depends on it
  /// How the picture is shown: it is made tile by tile as Frame::shown, and Frame::color stays empty. For methods
  /// whose request is local.
  const DisplayOptions* shown = nullptr;
  /// How the picture will be shown, for methods that average what is shown; null: as DisplayOptions{}.
  const DisplayOptions* display = nullptr;
  const Moment* last = nullptr;  ///< what Frame::motion is counted from; null: nothing moves
  const Moment* next = nullptr;  ///< what Frame::flow leads to
  // The scene's, made once for many frames; null: made for this one.
  const TextureSet* textures = nullptr;
  const InterleavedVertices* records = nullptr;
  RasterMemory* memory = nullptr;  ///< of earlier frames, to be used again; null: its own
};

/// Where time went and how much was done.
struct RenderCounts {
  double prepare_ms = 0, geometry_ms = 0, tiles_ms = 0;
  StageTimes stages;                   ///< of geometry and tiles
  std::uint64_t vertices = 0;          ///< of all draws
  std::uint64_t triangles = 0;         ///< given
  std::uint64_t triangles_set_up = 0;  ///< after culling and clipping
  std::uint64_t shaded = 0;            ///< points shaded
  std::uint64_t geometric = 0;         ///< points whose geometry alone was evaluated (Request::content)
};

/// Renders one frame of a scene as `request` asks, on the threads of the innermost `with_threads`.
///
/// Exact     the same bits for any number of threads and any Isa; triangle order does not matter (equal depths: the
///           earlier triangle wins).
Frame render(const Scene& scene, const Camera& camera, const Request& request, const RenderOptions& options,
             RenderCounts* counts = nullptr);

}  // namespace zoneplate
