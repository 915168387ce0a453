#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/raster/arena.h"
#include "zoneplate/raster/batch.h"
#include "zoneplate/raster/interpolate.h"
#include "zoneplate/raster/project.h"

namespace zoneplate {

enum class Surface {
  Opaque,
  Masked,   ///< there or not, by the shader's alpha
  Blended,  ///< laid over what is behind it, in exact order
};

/// Triangles that are drawn with one state: an instance of a mesh.
///
/// Its vertices come as positions with a matrix, or as clip positions. Triangles are numbered through the draws in
/// their order; the number is the last word where depths are equal.
struct Draw {
  std::span<const float3> position;
  float4x4 clip_from_object;
  std::span<const float4> clip;          ///< used where it is not empty
  std::span<const std::uint32_t> index;  ///< three a triangle

  /// Lines and points are drawn as two triangles each. Their attributes run from the mesh's vertex `ends[2 i]` of
  /// primitive i to `ends[2 i + 1]`, and a drawn vertex stands at its `share` of that way. Empty for triangles.
  std::span<const std::uint32_t> ends;
  std::span<const float> share;

  Surface surface = Surface::Opaque;
  bool culls_back_faces = false;
  bool is_mirrored = false;  ///< front faces are clockwise
  int material = 0;
  std::uint32_t instance = 0;

  std::size_t vertices() const { return clip.empty() ? position.size() : clip.size(); }
  std::size_t triangles() const { return index.size() / 3; }
  std::uint32_t primitive_of(std::uint32_t triangle) const { return ends.empty() ? triangle : triangle / 2; }
  float4 clip_position(std::uint32_t v) const {
    return clip.empty() ? clip_from_object * float4{position[v].x, position[v].y, position[v].z, 1} : clip[v];
  }
};

/// Draws with their screen vertices and triangle numbers.
struct ProjectedDraws {
  std::span<const Draw> draws;
  std::vector<std::span<ScreenVertex>> screen;  ///< by draw
  std::vector<std::int32_t> first_triangle;     ///< by draw, and the total at the end
  RawMemory memory;                             ///< of the screen vertices

  /// The draw that a triangle belongs to.
  std::size_t draw_of(std::int32_t triangle) const;
};

/// Transforms all vertices, in parallel. The memory of `reused` serves again.
///
/// Errors    Trouble::Failed past 2^31 - 2 triangles.
ProjectedDraws project_draws(std::span<const Draw> draws, Viewport viewport, Isa isa, ProjectedDraws reused = {});

/// What shading and culling need to know of a triangle as a whole.
struct TriangleFacing {
  BarycentricPlanes planes;    ///< if it needs clipping
  bool is_degenerate = false;  ///< no area on the screen
  bool is_clockwise = false;   ///< as seen on the screen
  bool needs_clipping = false;
};

TriangleFacing face_of(const ProjectedDraws& projected, std::size_t draw, std::int32_t triangle, Viewport viewport);

}  // namespace zoneplate
