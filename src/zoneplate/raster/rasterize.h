#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "zoneplate/raster/bin.h"
#include "zoneplate/raster/draw.h"
#include "zoneplate/raster/room.h"
#include "zoneplate/raster/setup.h"
#include "zoneplate/raster/stage_times.h"
#include "zoneplate/raster/target.h"

namespace zoneplate {

/// Gives colour to surface points, a batch at a time. Called from many threads at once.
class PointShader {
 public:
  virtual ~PointShader() = default;
  struct Wanted {
    bool normal = false, uv = false, albedo = false;
  };
  virtual void shade(const Batch& batch, Wanted wanted, Shaded& out) const = 0;
  /// Alpha of masked surfaces' points, and the cutoff at and above which such a point is there.
  virtual float alpha(const Batch& batch, float* out) const = 0;
  /// What no channel of any surface's colour, premultiplied, is above; it bounds how many layers are shaded.
  virtual float brightest() const { return std::numeric_limits<float>::infinity(); }
  /// Whether a material's batches need dbdx and dbdy.
  virtual bool wants_slopes([[maybe_unused]] int material) const { return true; }
  /// Where shading reads of an instance's vertices: vertex v at first + v × stride, so that it may be asked for before
  /// it is needed; null: nowhere.
  struct VertexMemory {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
  };
  virtual VertexMemory vertex_memory([[maybe_unused]] std::uint32_t instance, [[maybe_unused]] int material) const {
    return {};
  }
};

struct RasterRules {
  bool is_top_left = true;
  bool is_painter = false;
  Isa isa = best_isa();
  RasterRoom room;

  SetupRules setup(Viewport viewport) const {
    return {.viewport = viewport, .is_top_left = is_top_left, .is_flat_depth = is_painter};
  }
};

/// What frames that are drawn one after the other may share.
struct RasterMemory {
  ProjectedDraws projected;
  Bins bins;
  Rgba8Image shown;  ///< an earlier picture that is done with, where there is one
};

struct RasterCounts {
  double geometry_ms = 0, tiles_ms = 0;
  StageTimes stages;
  std::uint64_t vertices = 0, triangles = 0, set_up = 0, shaded = 0;
};

/// Draws triangles into a target: project, clip, set up, sort into tiles; then for each tile what is visible, shading
/// once per surface and pixel (or sample), layers of blended surfaces in exact order, and the mean of the samples.
///
/// Exact     the result does not depend on the number of threads, the Isa, or the order of the draws where no two
///           triangles have equal depth at a sample.
/// Source    visibility buffer: Burns and Hunt, The Visibility Buffer, JCGT 2(2), 2013; exact order per sample:
///           Carpenter, The A-buffer, SIGGRAPH 1984.
/// A `memory` that was used for an earlier frame saves the system's work of finding new pages.
RasterCounts rasterize(std::span<const Draw> draws, const PointShader& shader, const RasterRules& rules,
                       const Target& target, RasterMemory* memory = nullptr);

}  // namespace zoneplate
