// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/alpha.h"

#include <algorithm>

namespace zoneplate::antialias {
namespace {

// Relative difference of alpha at the centre from the mean of the corners that indicates a hole in the part.
constexpr float suspicious = 1.0f / 16;

bool is_there(float margin) { return margin >= 0; }

/// The line through two positions, with the inner side on the right of the direction from p to q (y down). If they
/// coincide, no point is inside.
Line line_through(Place p, Place q) {
  const double dx = q.x - p.x, dy = q.y - p.y, length = std::sqrt(dx * dx + dy * dy);
  if (!(length > 1e-9)) return {0, 0, -1};
  const double a = -dy / length, b = dx / length;
  return {a, b, -(a * p.x + b * p.y)};
}

}  // namespace

AlphaEdges::AlphaEdges(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target, int grid,
                       float part_footprint, float footprint)
    : grid_(grid), coarse_(projected, shader, target, part_footprint), fine_(projected, shader, target, footprint) {}

std::uint32_t AlphaEdges::add_query(int x, int y, std::int32_t id, std::uint32_t part) {
  const auto grid = static_cast<std::uint32_t>(grid_);
  queries_.push_back({x * 256, y * 256, id, static_cast<int>(part % grid), static_cast<int>(part / grid)});
  return static_cast<std::uint32_t>(queries_.size() - 1);
}

/// The position of the lattice nearest to the border of a square, of which there are grid × cells along a pixel's side.
std::int32_t AlphaEdges::place(int cell) const {
  const int count = grid_ * cells;
  return (2 * 256 * cell + count) / (2 * count);
}

Fragment AlphaEdges::corner_point(const Query& a, int column, int row) const {
  return {a.x + place(a.column * cells + column), a.y + place(a.row * cells + row), a.id, 0, 0};
}

void AlphaEdges::solve() {
  edges_.clear();
  collect_mixed();
  compute_grid_points();
  compute_crossings();
}

/// Determines the parts that contain an edge.
void AlphaEdges::collect_mixed() {
  points_.clear(), centres_.clear();
  for (const Query& a : queries_) {
    for (const int row : {0, cells})
      for (const int column : {0, cells}) points_.push_back(corner_point(a, column, row));
    centres_.push_back(corner_point(a, cells / 2, cells / 2));
  }
  const auto corner = fine_.margins(points_);
  const auto centre = coarse_.margins(centres_);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    const auto m = corner.subspan(4 * i, 4);
    const bool there = is_there(centre[i]);
    const float mean = ((m[0] + m[1]) + (m[2] + m[3])) / 4;
    const bool is_same = std::ranges::all_of(m, [&](float margin) { return is_there(margin) == there; }) &&
                         !(std::abs(centre[i] - mean) > suspicious * std::abs(mean));
    queries_[i].is_there = there;
    queries_[i].edge = is_same ? -1 : static_cast<std::int32_t>(edges_.size());
    if (!is_same) edges_.push_back({.query = static_cast<std::uint32_t>(i), .margin = {}, .crossing = {}});
  }
}

void AlphaEdges::compute_grid_points() {
  points_.clear();
  for (const Edge& e : edges_)
    for (int row = 0; row <= cells; ++row)
      for (int column = 0; column <= cells; ++column) points_.push_back(corner_point(queries_[e.query], column, row));
  const auto margin = fine_.margins(points_);
  for (std::size_t i = 0; i < edges_.size(); ++i) std::copy_n(&margin[i * corners], corners, edges_[i].margin.data());
}

void AlphaEdges::compute_crossings() {
  crossings_.clear();
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    std::uint32_t side = 0;
    for (int row = 0; row <= cells; ++row)
      for (int column = 0; column < cells; ++column) add_crossing(e, side++, column, row, false);
    for (int row = 0; row < cells; ++row)
      for (int column = 0; column <= cells; ++column) add_crossing(e, side++, column, row, true);
  }
  bisect();
}

void AlphaEdges::add_crossing(std::uint32_t edge, std::uint32_t side, int column, int row, bool is_upright) {
  const Edge& e = edges_[edge];
  const auto first = static_cast<std::size_t>(row * (cells + 1) + column);
  const float low = e.margin[first], high = e.margin[first + (is_upright ? cells + 1 : 1)];
  if (is_there(low) == is_there(high)) return;
  const Query& a = queries_[e.query];
  const Fragment p = corner_point(a, column, row);
  const Fragment q = is_upright ? corner_point(a, column, row + 1) : corner_point(a, column + 1, row);
  const std::int32_t begin = is_upright ? p.y : p.x, end = is_upright ? q.y : q.x;
  crossings_.push_back({edge, side, p, q, low, high, begin, end - begin});
}

/// Bisects the intervals that contain the crossings until each is between neighbouring lattice positions. Each step
/// evaluates alpha for all intervals at once.
void AlphaEdges::bisect() {
  const auto span = [](const Crossing& c) { return (c.high.x - c.low.x) + (c.high.y - c.low.y); };
  const auto middle = [](const Crossing& c) {
    Fragment p = c.low;
    p.x += (c.high.x - c.low.x) / 2, p.y += (c.high.y - c.low.y) / 2;
    return p;
  };
  for (;;) {
    points_.clear();
    for (const Crossing& c : crossings_)
      if (span(c) > 1) points_.push_back(middle(c));
    if (points_.empty()) break;
    const auto margin = fine_.margins(points_);
    std::size_t next = 0;
    for (Crossing& c : crossings_) {
      if (span(c) <= 1) continue;
      const Fragment p = points_[next];
      const float m = margin[next++];
      if (is_there(m) == is_there(c.margin_low))
        c.low = p, c.margin_low = m;
      else
        c.high = p, c.margin_high = m;
    }
  }
  for (const Crossing& c : crossings_) {
    const bool is_upright = c.side >= sides / 2;
    const float t = c.margin_low / (c.margin_low - c.margin_high);
    const float at = static_cast<float>((is_upright ? c.low.y : c.low.x) - c.begin) +
                     static_cast<float>(span(c)) * (t >= 0 && t <= 1 ? t : 0.5f);
    edges_[c.edge].crossing[c.side] = c.length > 0 ? at / static_cast<float>(c.length) : 0.5f;
  }
}

Place AlphaEdges::crossing_place(const Query& a, const Edge& e, int column, int row, bool is_upright) const {
  const double side = 1.0 / (grid_ * cells);
  const int number = is_upright ? static_cast<int>(sides / 2) + row * (cells + 1) + column : row * cells + column;
  const double t = static_cast<double>(e.crossing[static_cast<std::size_t>(number)]);
  const double x = a.column * cells + column + (is_upright ? 0 : t), y = a.row * cells + row + (is_upright ? t : 0);
  return {x * side, y * side};
}

AlphaEdges::Cuts AlphaEdges::cuts_of(const Query& a, const Edge& e, int column, int row) const {
  const auto margin = [&](int dx, int dy) {
    return e.margin[static_cast<std::size_t>((row + dy) * (cells + 1) + column + dx)];
  };
  // Clockwise on the screen from the upper left corner; side k runs from corner k to the next.
  const bool there[4] = {is_there(margin(0, 0)), is_there(margin(1, 0)), is_there(margin(1, 1)),
                         is_there(margin(0, 1))};
  const int count = there[0] + there[1] + there[2] + there[3];
  Cuts out{.keeps = count <= 2, .line = {}};
  if (count == 0 || count == 4) return out;
  const auto crossing = [&](int k) {
    switch (k & 3) {
      case 0:
        return crossing_place(a, e, column, row, false);
      case 1:
        return crossing_place(a, e, column + 1, row, true);
      case 2:
        return crossing_place(a, e, column, row + 1, false);
      default:
        return crossing_place(a, e, column, row, true);
    }
  };
  // Each run of consecutive corners with state `keeps` is bounded by two crossings, through which a line is cut.
  for (int k = 0; k < 4; ++k) {
    if (there[k] != out.keeps || there[(k + 3) & 3] == out.keeps) continue;
    int last = k;
    while (there[(last + 1) & 3] == out.keeps) ++last;
    out.line[static_cast<std::size_t>(out.count++)] = line_through(crossing(last), crossing(k + 3));
  }
  return out;
}

}  // namespace zoneplate::antialias
