#include "zoneplate/antialias/analytic_triangles.h"

#include <algorithm>

#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/clip.h"
#include "zoneplate/raster/coverage.h"

namespace zoneplate::antialias {
namespace {

/// A run of consecutive triangles of one draw.
struct Part {
  std::size_t draw;
  std::int32_t begin, end;
  std::vector<ScreenTriangle> out;
};

class PartMaker {
 public:
  PartMaker(const ProjectedDraws& projected, const Target& target, const SetupRules& rules, int reach, Part& part)
      : projected_(projected), target_(target), rules_(rules), reach_(reach), part_(part) {}

  void run() {
    const Draw& draw = projected_.draws[part_.draw];
    const auto& screen = projected_.screen[part_.draw];
    for (std::int32_t id = part_.begin; id < part_.end; ++id) {
      const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(id - projected_.first_triangle[part_.draw])];
      const ScreenVertex &p = screen[v[0]], &q = screen[v[1]], &r = screen[v[2]];
      if (p.needs_clipping() || q.needs_clipping() || r.needs_clipping()) {
        add_clipped(draw, id, v);
        continue;
      }
      const std::int64_t area = doubled_area(p, q, r);
      if (area != 0 && !is_culled(draw, area > 0)) emit(draw, p, q, r, id, false);
    }
  }

 private:
  static bool is_culled(const Draw& draw, bool is_clockwise) {
    return draw.culls_back_faces && is_clockwise != draw.is_mirrored;
  }

  /// The fan of what is left of a triangle; a sliver that snapping turned over is covered by the pieces beside it.
  void add_clipped(const Draw& draw, std::int32_t id, const std::uint32_t* v) {
    const ClippedPolygon polygon =
        clip_triangle(draw.clip_position(v[0]), draw.clip_position(v[1]), draw.clip_position(v[2]), rules_.viewport);
    if (polygon.count < 3) return;
    const TriangleFacing facing = face_of(projected_, part_.draw, id, rules_.viewport);
    if (facing.is_degenerate || is_culled(draw, facing.is_clockwise)) return;
    for (int i = 2; i < polygon.count; ++i) {
      const ScreenVertex& p = polygon.vertex[0];
      const ScreenVertex& q = polygon.vertex[static_cast<std::size_t>(i - 1)];
      const ScreenVertex& r = polygon.vertex[static_cast<std::size_t>(i)];
      const std::int64_t area = doubled_area(p, q, r);
      if (area != 0 && (area > 0) == facing.is_clockwise) emit(draw, p, q, r, id, true);
    }
  }

  void emit(const Draw& draw, const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, std::int32_t id,
            bool is_piece) {
    const Triangle t = make_triangle(p, q, r, id, rules_);
    if (t.min_x >= target_.x + target_.width + reach_ || t.max_x < target_.x - reach_ ||
        t.min_y >= target_.y + target_.height + reach_ || t.max_y < target_.y - reach_)
      return;
    part_.out.push_back({t, draw.surface, is_piece});
  }

  const ProjectedDraws& projected_;
  const Target& target_;
  const SetupRules& rules_;
  const int reach_;
  Part& part_;
};

std::vector<Part> parts_of(const ProjectedDraws& projected) {
  constexpr std::int32_t part_size = 4096;
  std::vector<Part> parts;
  for (std::size_t d = 0; d < projected.draws.size(); ++d)
    for (std::int32_t t = projected.first_triangle[d]; t < projected.first_triangle[d + 1]; t += part_size)
      parts.push_back({d, t, std::min(projected.first_triangle[d + 1], t + part_size), {}});
  return parts;
}

/// Calls use(tile) for every tile within `reach` pixels of the triangle's bounds.
template <class Use>
void for_tiles(const ScreenTriangles& s, const Triangle& t, const Target& target, int reach, Use use) {
  const int left = std::max(t.min_x - reach, target.x), right = std::min(t.max_x + reach, target.x + target.width - 1);
  const int top = std::max(t.min_y - reach, target.y), bottom = std::min(t.max_y + reach, target.y + target.height - 1);
  for (int row = top / tile_size; row <= bottom / tile_size; ++row)
    for (int column = left / tile_size; column <= right / tile_size; ++column)
      use(static_cast<std::size_t>((row - s.first_row) * s.columns + column - s.first_column));
}

}  // namespace

ScreenTriangles make_screen_triangles(const ProjectedDraws& projected, const Target& target, const SetupRules& rules,
                                      int reach) {
  std::vector<Part> parts = parts_of(projected);
  parallel_for(parts.size(), [&](std::size_t i) { PartMaker(projected, target, rules, reach, parts[i]).run(); });

  ScreenTriangles out;
  out.first_column = target.x / tile_size;
  out.first_row = target.y / tile_size;
  out.columns = (target.x + target.width - 1) / tile_size - out.first_column + 1;
  out.rows = (target.y + target.height - 1) / tile_size - out.first_row + 1;
  std::size_t total = 0;
  for (const Part& part : parts) total += part.out.size();
  out.triangles.reserve(total);
  for (Part& part : parts) {
    out.triangles.insert(out.triangles.end(), part.out.begin(), part.out.end());
    part.out = {};
  }

  // Counted first, then listed: a tile's numbers rise.
  const auto tile_count = static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
  out.first.assign(tile_count + 1, 0);
  for (const ScreenTriangle& t : out.triangles)
    for_tiles(out, t.shape, target, reach, [&](std::size_t tile) { ++out.first[tile + 1]; });
  for (std::size_t i = 0; i < tile_count; ++i) out.first[i + 1] += out.first[i];
  out.listed.resize(out.first.back());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t i = 0; i < out.triangles.size(); ++i)
    for_tiles(out, out.triangles[i].shape, target, reach,
              [&](std::size_t tile) { out.listed[next[tile]++] = static_cast<std::uint32_t>(i); });
  return out;
}

}  // namespace zoneplate::antialias
