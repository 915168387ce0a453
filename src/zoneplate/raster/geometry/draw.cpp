// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/draw.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/geometry/clip.h"
#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/types/tile_grid.h"

namespace zoneplate {

std::size_t ProjectedDraws::draw_of(std::int32_t triangle) const {
  const auto after = std::upper_bound(first_triangle.begin(), first_triangle.end(), triangle);
  return static_cast<std::size_t>(after - first_triangle.begin()) - 1;
}

namespace {

constexpr std::size_t batch_vertices = std::size_t{1} << 20;  ///< of draws that are not kept
constexpr std::size_t batch_draws = std::size_t{1} << 16;     ///< likewise
constexpr std::size_t always_kept = std::size_t{1} << 22;

/// The vertices of the draws' meshes, each mesh once.
std::size_t mesh_vertices(std::span<const Draw> draws) {
  std::vector<std::pair<const void*, std::size_t>> meshes;
  for (const Draw& draw : draws) {
    if (draw.continues || draw.elsewhere > 0) continue;
    const void* const first = draw.quads          ? static_cast<const void*>(draw.quads)
                              : draw.clip.empty() ? static_cast<const void*>(draw.position.data())
                                                  : draw.clip.data();
    if (meshes.empty() || meshes.back().first != first) meshes.emplace_back(first, draw.vertices());
  }
  std::sort(meshes.begin(), meshes.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
  std::size_t sum = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (i == 0 || meshes[i].first != meshes[i - 1].first) sum += meshes[i].second;
  return sum;
}

/// The draws' screen vertices, one draw's after the other's.
void project_batch(const ProjectedDraws& projected, std::size_t first, std::size_t last,
                   const ProjectKernels& kernels) {
  struct Part {
    std::size_t draw, begin, end;
  };
  constexpr std::size_t part_size = 1024;
  std::vector<Part> parts;
  for (std::size_t d = first; d < last; ++d)
    for (std::size_t v = 0; v < projected.screen[d].size(); v += part_size)
      parts.push_back({d, v, std::min(projected.screen[d].size(), v + part_size)});
  parallel_for(parts.size(), [&](std::size_t i) {
    const Part& part = parts[i];
    const Draw& draw = projected.draws[part.draw];
    ScreenVertex* screen = projected.screen[part.draw].data();
    if (draw.quads) {
      for (std::size_t v = part.begin; v < part.end; v += 4) {
        const Quad quad = make_quad(*draw.quads, v / 4, draw.clip_from_object);
        for (std::size_t k = 0; k < 4; ++k) screen[v + k] = project(quad.clip[k], projected.viewport);
      }
    } else if (draw.clip.empty()) {
      kernels.transform(draw.clip_from_object, draw.position.data() + part.begin, part.end - part.begin,
                        projected.viewport, screen + part.begin);
    } else {
      for (std::size_t v = part.begin; v < part.end; ++v) screen[v] = project(draw.clip[v], projected.viewport);
    }
  });
}

/// Gives parts of an instance the screen vertices of its first part.
void share_screen_vertices(ProjectedDraws& projected, std::size_t first, std::size_t last) {
  std::span<ScreenVertex> of_first;
  for (std::size_t d = first; d < last; ++d) {
    if (projected.draws[d].elsewhere > 0) continue;
    if (projected.draws[d].continues) projected.screen[d] = of_first;
    of_first = projected.screen[d];
  }
}

ScreenVertex* screen_memory(RawMemory& memory, std::size_t vertices) {
  return growing("screen vertices",
                 [&] { return reinterpret_cast<ScreenVertex*>(memory.reserve(vertices * sizeof(ScreenVertex))); });
}

}  // namespace

ProjectedDraws number_draws(std::span<const Draw> draws, Viewport viewport, std::optional<std::size_t> kept,
                            ProjectedDraws reused) {
  ProjectedDraws out = std::move(reused);
  out.draws = draws;
  out.viewport = viewport;
  out.screen.assign(draws.size(), {});
  out.first_triangle.assign(1, 0);
  out.first_triangle.reserve(draws.size() + 1);
  std::size_t triangles = 0, vertices = 0;
  for (const Draw& draw : draws) {
    triangles += draw.triangles(), vertices += draw.vertices();
    if (triangles > 0x7ffffffeu) throw Error(ErrorKind::Failed, "the scene has more than 2147483646 triangles");
    out.first_triangle.push_back(static_cast<std::int32_t>(triangles));
  }
  const bool is_few = !kept && vertices <= always_kept;
  out.kept = std::min(vertices, kept ? *kept : is_few ? always_kept : std::max(always_kept, mesh_vertices(draws)));
  return out;
}

std::size_t project_kept(ProjectedDraws& p) {
  ScreenVertex* place = screen_memory(p.memory, p.kept);
  std::size_t left = p.kept, last = 0;
  for (; last < p.draws.size() && p.draws[last].vertices() <= left; ++last) {
    const std::size_t count = p.draws[last].vertices();
    p.screen[last] = {place, count};
    place += count, left -= count;
  }
  project_batch(p, 0, last, ProjectKernels::of());
  share_screen_vertices(p, 0, last);
  return last;
}

void project_batches(ProjectedDraws& p, const std::function<void(std::size_t, std::size_t)>& use) {
  std::size_t last = project_kept(p);
  use(0, last);

  // The other draws: as many as fit into a batch, but at least one.
  while (last < p.draws.size()) {
    const std::size_t first = last;
    std::size_t count = p.draws[last++].vertices();
    const auto fits = [&] {
      const Draw& next = p.draws[last];
      return next.continues || (last - first < batch_draws && count + next.vertices() <= batch_vertices);
    };
    for (; last < p.draws.size() && fits(); ++last) count += p.draws[last].vertices();
    ScreenVertex* place = screen_memory(p.batch_memory, count);
    for (std::size_t d = first; d < last; place += p.draws[d++].vertices())
      p.screen[d] = {place, p.draws[d].vertices()};
    project_batch(p, first, last, ProjectKernels::of());
    share_screen_vertices(p, first, last);
    use(first, last);
    for (std::size_t d = first; d < last; ++d) p.screen[d] = {};
  }
}

ProjectedDraws project_draws(std::span<const Draw> draws, Viewport viewport, ProjectedDraws reused) {
  ProjectedDraws out = number_draws(draws, viewport, std::numeric_limits<std::size_t>::max(), std::move(reused));
  project_kept(out);
  return out;
}

}  // namespace zoneplate
