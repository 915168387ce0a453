#include "zoneplate/raster/draw.h"

#include <algorithm>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/setup.h"

namespace zoneplate {

std::size_t ProjectedDraws::draw_of(std::int32_t triangle) const {
  const auto after = std::upper_bound(first_triangle.begin(), first_triangle.end(), triangle);
  return static_cast<std::size_t>(after - first_triangle.begin()) - 1;
}

ProjectedDraws project_draws(std::span<const Draw> draws, Viewport viewport, Isa isa, ProjectedDraws reused) {
  ProjectedDraws out = std::move(reused);
  out.draws = draws;
  out.screen.clear();
  out.first_triangle.clear();
  std::size_t total = 0, vertices = 0;
  for (const Draw& draw : draws) vertices += draw.vertices();
  auto* place = reinterpret_cast<ScreenVertex*>(out.memory.room(vertices * sizeof(ScreenVertex)));
  struct Part {
    std::size_t draw, begin, end;
  };
  std::vector<Part> parts;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    out.screen.emplace_back(place, draws[d].vertices());
    place += draws[d].vertices();
    out.first_triangle.push_back(static_cast<std::int32_t>(total));
    total += draws[d].triangles();
    if (total > 0x7ffffffeu) throw Error(Trouble::Failed, "the scene has more than 2147483646 triangles");
    for (std::size_t v = 0; v < draws[d].vertices(); v += 4096)
      parts.push_back({d, v, std::min(draws[d].vertices(), v + 4096)});
  }
  out.first_triangle.push_back(static_cast<std::int32_t>(total));

  const ProjectKernels& kernels = project_kernels(isa);
  parallel_for(parts.size(), [&](std::size_t i) {
    const Part& part = parts[i];
    const Draw& draw = draws[part.draw];
    ScreenVertex* screen = out.screen[part.draw].data();
    if (draw.clip.empty()) {
      kernels.transform(draw.clip_from_object, draw.position.data() + part.begin, part.end - part.begin, viewport,
                        screen + part.begin);
    } else {
      for (std::size_t v = part.begin; v < part.end; ++v) screen[v] = project(draw.clip[v], viewport);
    }
  });
  return out;
}

TriangleFacing face_of(const ProjectedDraws& projected, std::size_t d, std::int32_t triangle, Viewport viewport) {
  const Draw& draw = projected.draws[d];
  const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(triangle - projected.first_triangle[d])];
  const ScreenVertex &p = projected.screen[d][v[0]], &q = projected.screen[d][v[1]], &r = projected.screen[d][v[2]];
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
