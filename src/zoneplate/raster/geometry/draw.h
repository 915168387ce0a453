// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/raster/geometry/arena.h"
#include "zoneplate/raster/geometry/project.h"
#include "zoneplate/raster/geometry/quads.h"
#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/types/batch.h"
#include "zoneplate/scene/alpha_mode.h"

namespace zoneplate {

/// Triangles that are drawn with one state: an instance of a mesh.
///
/// The vertices are positions with a matrix, clip positions, or those of quads. Triangle ids count the triangles of all
/// draws in their order; of equal depths the lower id is visible.
struct Draw {
  std::span<const float3> position;
  float4x4 clip_from_object;
  std::span<const float4> clip;          ///< used where it is not empty
  std::span<const std::uint32_t> index;  ///< three a triangle

  /// Lines and points, drawn as two triangles each; null: triangles. `position` and `clip` are not used then.
  const QuadMesh* quads = nullptr;

  AlphaMode alpha_mode = AlphaMode::Opaque;
  bool culls_back_faces = false;
  bool is_mirrored = false;  ///< front faces are clockwise
  int material = 0;
  std::uint32_t instance = 0;

  // Of an instance that several processes draw (raster/parts/): its parts are draws of their own.
  std::uint32_t first_primitive = 0;  ///< number of the draw's first primitive in its mesh
  std::uint32_t elsewhere = 0;        ///< triangles that another process draws: they have ids, but no `index`
  bool continues = false;             ///< a part after the first with vertices, whose screen vertices it shares

  /// The number of its own screen vertices.
  std::size_t vertices() const {
    return continues ? 0 : quads ? quads->vertices() : clip.empty() ? position.size() : clip.size();
  }
  std::size_t triangles() const { return index.size() / 3 + elsewhere; }
  std::uint32_t primitive_of(std::uint32_t triangle) const {
    return first_primitive + (quads ? triangle / 2 : triangle);
  }
  float4 clip_position(std::uint32_t v) const {
    if (quads) return make_quad(*quads, v / 4, clip_from_object).clip[v % 4];
    return clip.empty() ? clip_from_object * float4{position[v].x, position[v].y, position[v].z, 1} : clip[v];
  }
};

/// Draws with their screen vertices and triangle ids.
///
/// Instances share the vertices of their mesh but not its screen vertices, of which there may be more than memory.
/// The screen vertices of the first draws are stored up to a capacity; those of the other draws are stored while their
/// batch is processed, and computed again one by one where a triangle is visible.
struct ProjectedDraws {
  std::span<const Draw> draws;
  Viewport viewport;
  std::vector<std::span<ScreenVertex>> screen;  ///< by draw; empty where they are not stored
  std::vector<std::int32_t> first_triangle;     ///< by draw, and the total at the end
  std::size_t kept = 0;                         ///< number of screen vertices of the first draws that are stored
  RawMemory memory, batch_memory;               ///< of the screen vertices

  /// The draw that a triangle belongs to.
  std::size_t draw_of(std::int32_t triangle) const;
  /// A screen vertex of a draw: stored, or computed again.
  ScreenVertex vertex(std::size_t draw, std::uint32_t v) const {
    return screen[draw].empty() ? project(draws[draw].clip_position(v), viewport) : screen[draw][v];
  }
};

/// Assigns the triangle ids; no screen vertices are stored yet. The memory of `reused` is used again.
///
/// `kept`: screen vertices that are kept; none: as many as the draws' meshes have, or 2^22 where that is more.
/// Errors    ErrorKind::Failed past 2^31 - 2 triangles.
ProjectedDraws number_draws(std::span<const Draw> draws, Viewport viewport, std::optional<std::size_t> kept = {},
                            ProjectedDraws reused = {});

/// Transforms the vertices of the draws that are kept, in parallel; returns the number of these draws.
std::size_t project_kept(ProjectedDraws& projected);

/// Transforms the vertices, in parallel, in batches of draws: `use(first, last)` is called for each batch while the
/// screen vertices of the draws [first, last) are stored. Draws that are kept fit into one batch.
void project_batches(ProjectedDraws& projected, const std::function<void(std::size_t, std::size_t)>& use);

/// number_draws and project_kept, with all screen vertices kept.
ProjectedDraws project_draws(std::span<const Draw> draws, Viewport viewport, ProjectedDraws reused = {});

}  // namespace zoneplate
