// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/triangles.h"

#include <algorithm>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/geometry/clip_fan.h"

namespace zoneplate::antialias {
namespace {

constexpr std::int32_t part_size = 4096;

}  // namespace

TileTriangles::TileTriangles(const ProjectedDraws& projected, const Target& target, const RasterRules& rules,
                             int radius)
    : projected_(projected), target_(target), rules_(rules), radius_(radius) {
  first_column_ = target.x / tile_size;
  first_row_ = target.y / tile_size;
  columns_ = (target.x + target.width - 1) / tile_size - first_column_ + 1;
  rows_ = (target.y + target.height - 1) / tile_size - first_row_ + 1;
  for (std::size_t d = 0; d < projected.draws.size(); ++d)
    for (std::int32_t t = projected.first_triangle[d]; t < projected.first_triangle[d + 1];
         t += std::min(part_size, projected.first_triangle[d + 1] - t))
      parts_.push_back({d, t, t + std::min(part_size, projected.first_triangle[d + 1] - t)});

  const auto tiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  counter_ = std::make_unique<std::atomic<std::uint32_t>[]>(tiles);
  std::atomic<std::uint64_t> count = 0;
  parallel_for(parts_.size(), [&](std::size_t i) {
    std::uint64_t here = 0;
    for_triangles(parts_[i], [&](std::int32_t, const Box& box) {
      ++here;
      for_tiles(box, [&](std::size_t tile) { counter_[tile].fetch_add(1, std::memory_order_relaxed); });
    });
    count += here;
  });
  count_ = count;
  first_.assign(tiles + 1, 0);
  for (std::size_t i = 0; i < tiles; ++i) first_[i + 1] = first_[i] + counter_[i];
}

/// Calls use(p, q, r, is_piece) for the pieces of a triangle after culling and clipping.
template <class Use>
void TileTriangles::for_pieces(std::size_t number, std::int32_t id, Use use) const {
  const Draw& draw = projected_.draws[number];
  const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(id - projected_.first_triangle[number])];
  const ScreenVertex p = projected_.vertex(number, v[0]), q = projected_.vertex(number, v[1]),
                     r = projected_.vertex(number, v[2]);
  if (!p.needs_clipping() && !q.needs_clipping() && !r.needs_clipping()) {
    const std::int64_t area = doubled_area(p, q, r);
    if (area != 0 && !is_culled(draw, area > 0)) use(p, q, r, false);
    return;
  }
  for_clipped_triangles(projected_, number, id, v, target_.viewport,
                        [&](const ScreenVertex& first, const ScreenVertex& second, const ScreenVertex& third) {
                          use(first, second, third, true);
                        });
}

/// Calls use(id, box) for the triangles of a part that overlap the target; the box includes all pieces.
template <class Use>
void TileTriangles::for_triangles(const Part& part, Use use) const {
  const int centre_x = target_.viewport.width * 128, centre_y = target_.viewport.height * 128;
  for (std::int32_t id = part.begin; id < part.end; ++id) {
    bool is_seen = false;
    Box box{0, 0, 0, 0};
    for_pieces(part.draw, id, [&](const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, bool) {
      const Box here{(std::min({p.x, q.x, r.x}) + centre_x) >> 8, (std::min({p.y, q.y, r.y}) + centre_y) >> 8,
                     (std::max({p.x, q.x, r.x}) + centre_x) >> 8, (std::max({p.y, q.y, r.y}) + centre_y) >> 8};
      box = is_seen ? Box{std::min(box.left, here.left), std::min(box.top, here.top), std::max(box.right, here.right),
                          std::max(box.bottom, here.bottom)}
                    : here;
      is_seen = true;
    });
    if (is_seen && box.left < target_.x + target_.width + radius_ && box.right >= target_.x - radius_ &&
        box.top < target_.y + target_.height + radius_ && box.bottom >= target_.y - radius_)
      use(id, box);
  }
}

/// Calls use(tile) for every tile within `radius` pixels of a box.
template <class Use>
void TileTriangles::for_tiles(const Box& box, Use use) const {
  const int left = std::max(box.left - radius_, target_.x);
  const int right = std::min(box.right + radius_, target_.x + target_.width - 1);
  const int top = std::max(box.top - radius_, target_.y);
  const int bottom = std::min(box.bottom + radius_, target_.y + target_.height - 1);
  for (int row = top / tile_size; row <= bottom / tile_size; ++row)
    for (int column = left / tile_size; column <= right / tile_size; ++column)
      use(static_cast<std::size_t>((row - first_row_) * columns_ + column - first_column_));
}

int TileTriangles::list_rows(int first) {
  const auto tile_of = [&](int row) { return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_); };
  listed_from_ = first_[tile_of(first)];
  int last = first + 1;
  while (last < rows_ && first_[tile_of(last + 1)] - listed_from_ <= max_listed) ++last;
  const std::size_t begin = tile_of(first), end = tile_of(last);
  growing("numbers of triangles in tiles", [&] { listed_.resize(first_[end] - listed_from_); });
  for (std::size_t tile = begin; tile < end; ++tile) counter_[tile] = 0;
  parallel_for(parts_.size(), [&](std::size_t i) {
    for_triangles(parts_[i], [&](std::int32_t id, const Box& box) {
      for_tiles(box, [&](std::size_t tile) {
        if (tile < begin || tile >= end) return;
        listed_[first_[tile] - listed_from_ + counter_[tile].fetch_add(1, std::memory_order_relaxed)] = id;
      });
    });
  });
  return last;
}

void TileTriangles::make(std::size_t tile, int top, int bottom, std::vector<ScreenTriangle>& out) const {
  out.clear();
  std::size_t draw = 0;
  for (const std::int32_t id : of_tile(tile)) {
    if (id < projected_.first_triangle[draw] || id >= projected_.first_triangle[draw + 1])
      draw = projected_.draw_of(id);
    for_pieces(draw, id, [&](const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, bool is_piece) {
      const int centre = target_.viewport.height * 128;
      if ((std::max({p.y, q.y, r.y}) + centre) >> 8 < top || (std::min({p.y, q.y, r.y}) + centre) >> 8 >= bottom)
        return;
      out.push_back(
          {make_triangle(p, q, r, id, target_.viewport, rules_), projected_.draws[draw].alpha_mode, is_piece});
    });
  }
}

}  // namespace zoneplate::antialias
