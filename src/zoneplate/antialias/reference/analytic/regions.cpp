// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/regions.h"

#include <algorithm>

#include "zoneplate/base/deadline.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t crowd = 16;  // a region with more cutting triangles is divided into quarters
// Regions with more are divided even if the last two divisions had little effect.
constexpr std::size_t large = 256;
constexpr std::size_t max_levels = 6;  // levels of division: the smallest regions have a side of 1/64 pixel

ConvexPolygon square_at(double x, double y, double side) {
  ConvexPolygon out;
  for (const Place p : {Place{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}) out.add(p);
  return out;
}

bool covers(const PixelTriangle& triangle, const ConvexPolygon& square) {
  if (triangle.covers_all) return true;
  for (const Line& edge : triangle.edge)
    for (int i = 0; i < square.count; ++i)
      if (edge.distance(square[i]) < -on_line) return false;
  return true;
}

bool misses(const PixelTriangle& triangle, const ConvexPolygon& square) {
  if (triangle.covers_all) return false;
  return std::any_of(std::begin(triangle.edge), std::end(triangle.edge),
                     [&](const Line& edge) { return is_outside(square, edge); });
}

}  // namespace

bool PixelRegions::find(std::span<const PixelTriangle> triangles, const Use& use) {
  triangles_ = triangles;
  work_ = 0;
  members_.resize(max_levels + 2);
  members_[0].clear();
  for (std::uint32_t i = 0; i < triangles.size(); ++i) members_[0].push_back({i, triangles[i].covers_all, 0, 0});
  if (triangles.size() > crowd) return find_in(unit_square(), 1, {}, use);
  cells_.clear(unit_square());
  for (const PixelTriangle& t : triangles)
    if (!insert(t)) return false;
  return use(cells_);
}

bool PixelRegions::insert(const PixelTriangle& triangle) {
  work_ += cells_.cells().size() + cells_.layer_count() / 4;
  cells_.insert(triangle);
  return !cells_.is_full() && work_ <= max_work;
}

/// Computes members_[level]: the members of the level above that overlap the square and are not entirely hidden in it.
void PixelRegions::gather(const ConvexPolygon& square, std::size_t level) {
  std::vector<Member>& found = members_[level];
  found.clear();
  double hidden_below = -1;
  for (const Member& m : members_[level - 1]) {
    const PixelTriangle& t = triangles_[m.number];
    if (misses(t, square)) continue;
    double least = 0, greatest = 0;
    for (int i = 0; i < square.count; ++i) {
      const double z = (t.z + t.zx * square[i].x) + t.zy * square[i].y;
      least = i == 0 ? z : std::min(least, z);
      greatest = i == 0 ? z : std::max(greatest, z);
    }
    const bool is_cover = covers(t, square);
    if (is_cover && t.alpha_mode == AlphaMode::Opaque) hidden_below = std::max(hidden_below, least);
    found.push_back({m.number, is_cover, least, greatest});
  }
  std::erase_if(found, [&](const Member& m) { return m.max_depth < hidden_below; });
}

/// The number of members of members_[level] that have an edge in the region, or may intersect another one in it.
std::size_t PixelRegions::count_cutters(std::size_t level) {
  covering_.clear();
  for (const Member& m : members_[level])
    if (m.covers) covering_.push_back(m);
  std::size_t cutters = members_[level].size() - covering_.size();
  std::sort(covering_.begin(), covering_.end(),
            [](const Member& a, const Member& b) { return a.max_depth > b.max_depth; });
  for (std::size_t i = 1; i < covering_.size(); ++i) {
    if (covering_[i].max_depth >= covering_[i - 1].min_depth) ++cutters;
    covering_[i].min_depth = std::min(covering_[i].min_depth, covering_[i - 1].min_depth);
  }
  return cutters;
}

bool PixelRegions::find_in(const ConvexPolygon& square, std::size_t level, Crowd above, const Use& use) {
  check_deadline();
  gather(square, level);
  if (members_[level].empty()) return true;
  // Nearly parallel lines through a pixel also pass together through its quarters, so that division has little effect.
  const std::size_t cutters = count_cutters(level);
  const Crowd here{cutters, 4 * cutters > 3 * above.cutters && above.cutters > 0 ? above.in_vain + 1 : 0};
  if (cutters > crowd && level < max_levels + 1 && (here.in_vain < 2 || cutters > large)) {
    const Place corner = square[0];
    const double half = (square[1].x - corner.x) / 2;
    for (const Place p :
         {corner, {corner.x + half, corner.y}, {corner.x, corner.y + half}, {corner.x + half, corner.y + half}})
      if (!find_in(square_at(p.x, p.y, half), level + 1, here, use)) return false;
    return true;
  }
  cells_.clear(square);
  for (const Member& m : members_[level]) {
    PixelTriangle t = triangles_[m.number];
    t.covers_all = m.covers;
    if (!insert(t)) return false;
  }
  return use(cells_);
}

}  // namespace zoneplate::antialias
