#include "zoneplate/raster/draw.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/memory_limit.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/clip.h"
#include "zoneplate/raster/coverage.h"
#include "zoneplate/raster/setup.h"

namespace zoneplate {

std::size_t ProjectedDraws::draw_of(std::int32_t triangle) const {
  const auto after = std::upper_bound(first_triangle.begin(), first_triangle.end(), triangle);
  return static_cast<std::size_t>(after - first_triangle.begin()) - 1;
}

namespace {

constexpr std::size_t batch_vertices = std::size_t{1} << 20;  ///< that are not kept
constexpr std::size_t batch_draws = std::size_t{1} << 16;     ///< likewise
constexpr std::size_t always_kept = std::size_t{1} << 22;

/// The vertices of the draws' meshes, each mesh once.
std::size_t mesh_vertices(std::span<const Draw> draws) {
  std::vector<std::pair<const void*, std::size_t>> meshes;
  for (const Draw& draw : draws) {
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
  constexpr std::size_t part_size = 4096;
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

ScreenVertex* screen_memory(RawMemory& memory, std::size_t vertices) {
  return growing("screen vertices",
                 [&] { return reinterpret_cast<ScreenVertex*>(memory.room(vertices * sizeof(ScreenVertex))); });
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
    if (triangles > 0x7ffffffeu) throw Error(Trouble::Failed, "the scene has more than 2147483646 triangles");
    out.first_triangle.push_back(static_cast<std::int32_t>(triangles));
  }
  const bool is_few = !kept && vertices <= always_kept;
  out.kept = std::min(vertices, kept ? *kept : is_few ? always_kept : std::max(always_kept, mesh_vertices(draws)));
  return out;
}

std::size_t project_kept(ProjectedDraws& p, Isa isa) {
  ScreenVertex* place = screen_memory(p.memory, p.kept);
  std::size_t left = p.kept, last = 0;
  for (; last < p.draws.size() && p.draws[last].vertices() <= left; ++last) {
    const std::size_t count = p.draws[last].vertices();
    p.screen[last] = {place, count};
    place += count, left -= count;
  }
  project_batch(p, 0, last, project_kernels(isa));
  return last;
}

void project_batches(ProjectedDraws& p, Isa isa, const std::function<void(std::size_t, std::size_t)>& use) {
  std::size_t last = project_kept(p, isa);
  use(0, last);

  // The others, as many as fit into a batch, but at least one.
  while (last < p.draws.size()) {
    const std::size_t first = last;
    std::size_t count = p.draws[last++].vertices();
    for (; last < p.draws.size() && last - first < batch_draws && count + p.draws[last].vertices() <= batch_vertices;
         ++last)
      count += p.draws[last].vertices();
    ScreenVertex* place = screen_memory(p.batch_memory, count);
    for (std::size_t d = first; d < last; place += p.draws[d++].vertices())
      p.screen[d] = {place, p.draws[d].vertices()};
    project_batch(p, first, last, project_kernels(isa));
    use(first, last);
    for (std::size_t d = first; d < last; ++d) p.screen[d] = {};
  }
}

ProjectedDraws project_draws(std::span<const Draw> draws, Viewport viewport, Isa isa, ProjectedDraws reused) {
  ProjectedDraws out = number_draws(draws, viewport, std::numeric_limits<std::size_t>::max(), std::move(reused));
  project_kept(out, isa);
  return out;
}

namespace {

/// A point on the screen, 1/256 pixel from the picture's top-left corner.
struct ScreenPoint {
  std::int32_t x, y;
};

/// As make_tile_triangle and depth_at have it.
float depth_of(const Triangle& t, ScreenPoint at) {
  const int column = at.x >> 8, row = at.y >> 8;
  const SamplePosition place{static_cast<std::uint8_t>(at.x & 255), static_cast<std::uint8_t>(at.y & 255)};
  TileTriangle here;
  make_tile_triangle(t, &place, 1, column / tile_size * tile_size, row / tile_size * tile_size, here);
  return depth_at(here, 0, column % tile_size, row % tile_size);
}

bool contains(const Triangle& t, ScreenPoint p) {
  for (std::size_t k = 0; k < 3; ++k)
    if (static_cast<std::int64_t>(t.a[k]) * p.x + static_cast<std::int64_t>(t.b[k]) * p.y + t.c[k] < 0) return false;
  return true;
}

/// The depth of the plane through homogeneous vertices: their weights, but for a factor that depth does not see.
float depth_of(const float4 (&corner)[3], ScreenPoint at, Viewport viewport) {
  const BarycentricPlanes planes = barycentric_planes(corner[0], corner[1], corner[2], viewport);
  const double px = at.x - viewport.width * 128, py = at.y - viewport.height * 128;
  double z = 0, w = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = (planes.x[k] * px + planes.y[k] * py) + planes.one[k];
    z += weight * static_cast<double>(corner[k].z), w += weight * static_cast<double>(corner[k].w);
  }
  const double depth = z / w;
  return depth > 0 ? static_cast<float>(depth < 1 ? depth : 1.0) : 0.0f;
}

}  // namespace

float depth_at_point(const ProjectedDraws& projected, std::size_t d, std::int32_t triangle, std::int32_t x,
                     std::int32_t y, const SetupRules& rules) {
  const Draw& draw = projected.draws[d];
  const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(triangle - projected.first_triangle[d])];
  const ScreenVertex p = projected.vertex(d, v[0]), q = projected.vertex(d, v[1]), r = projected.vertex(d, v[2]);
  const ScreenPoint at{x, y};
  if (!p.needs_clipping() && !q.needs_clipping() && !r.needs_clipping())
    return depth_of(make_triangle(p, q, r, triangle, rules), at);
  const float4 corner[3] = {draw.clip_position(v[0]), draw.clip_position(v[1]), draw.clip_position(v[2])};
  const ClippedPolygon polygon = clip_triangle(corner[0], corner[1], corner[2], rules.viewport);
  for (int i = 2; i < polygon.count; ++i) {
    const ScreenVertex &a = polygon.vertex[0], &b = polygon.vertex[static_cast<std::size_t>(i - 1)],
                       &c = polygon.vertex[static_cast<std::size_t>(i)];
    if (doubled_area(a, b, c) == 0) continue;
    const Triangle piece = make_triangle(a, b, c, triangle, rules);
    if (contains(piece, at)) return depth_of(piece, at);
  }
  return depth_of(corner, at, rules.viewport);
}

TriangleFacing face_of(const ProjectedDraws& projected, std::size_t d, std::int32_t triangle, Viewport viewport) {
  const Draw& draw = projected.draws[d];
  const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(triangle - projected.first_triangle[d])];
  const ScreenVertex p = projected.vertex(d, v[0]), q = projected.vertex(d, v[1]), r = projected.vertex(d, v[2]);
  TriangleFacing out;
  out.needs_clipping = p.needs_clipping() || q.needs_clipping() || r.needs_clipping();
  if (!out.needs_clipping) {
    const std::int64_t area = doubled_area(p, q, r);
    out.is_degenerate = area == 0;
    out.is_clockwise = area > 0;
    return out;
  }
  // The determinant of the homogeneous vertices has the sign of the area of whatever part is in front of the eye.
  const float4 a = draw.clip_position(v[0]);
  out.planes = barycentric_planes(a, draw.clip_position(v[1]), draw.clip_position(v[2]), viewport);
  const double area = (out.planes.x[0] * (static_cast<double>(a.x) * (viewport.width * 128)) +
                       out.planes.y[0] * (static_cast<double>(a.y) * (viewport.height * -128))) +
                      out.planes.one[0] * static_cast<double>(a.w);
  out.is_degenerate = !(area < 0 || area > 0);
  out.is_clockwise = area > 0;
  return out;
}

}  // namespace zoneplate
