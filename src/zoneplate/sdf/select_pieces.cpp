// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "zoneplate/base/deadline.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/sdf/evaluate.h"
#include "zoneplate/sdf/evaluate_lanes.h"

namespace zoneplate::sdf {
namespace {

/// Selects parts for a rectangle of points.
class PieceSelector {
 public:
  PieceSelector(const Program& program, const LocalRectangle& points, PieceSelection& out)
      : pieces_(program.pieces().data()),
        points_(points),
        middle_x_((points.low_x + points.high_x) * 0.5f),
        middle_y_((points.low_y + points.high_y) * 0.5f),
        out_(out) {
    out.near.clear(), out.beside.clear(), out.distances.clear();
    out.winding = 0;
  }

  /// `piece(i)` is the number of the i-th of `count` parts.
  template <class Number>
  void select(std::size_t count, const Number& piece) {
    // No point is farther from the outline than the middle is, and half of the diagonal. A part that is nearest to a
    // point is farther from the middle by half of the diagonal again at most.
    float nearest = 1e30f;
    for (std::size_t i = 0; i < count; ++i) {
      const Piece& p = pieces_[piece(i)];
      out_.distances.push_back(distance_from_middle(p));
      nearest = std::min(nearest, out_.distances.back() + p.bulge);
    }
    const float half_x = points_.high_x - middle_x_, half_y = points_.high_y - middle_y_;
    const float reach = (nearest + 2 * std::sqrt(half_x * half_x + half_y * half_y)) * 1.0001f + 1e-6f;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t number = piece(i);
      if (out_.distances[i] <= reach + pieces_[number].bulge)
        out_.near.push_back(number);
      else if (is_right(pieces_[number]))
        count_right(number);
    }
  }

  /// Counts a part to the right of all points at its heights.
  void count_right(std::int32_t number) {
    const Piece& p = pieces_[number];
    if (p.direction == 0 || p.low_y > points_.high_y || p.high_y <= points_.low_y) return;
    if (p.low_y <= points_.low_y && p.high_y > points_.high_y)
      out_.winding += p.direction;
    else
      out_.beside.push_back(number);
  }

 private:
  /// The distance of the middle from the line between a part's ends.
  float distance_from_middle(const Piece& p) const {
    const float x = middle_x_ - p.start_x, y = middle_y_ - p.start_y;
    const float chord_x = p.end_x - p.start_x, chord_y = p.end_y - p.start_y;
    const float t = std::min(std::max((x * chord_x + y * chord_y) * p.inverse_square, 0.0f), 1.0f);
    const float qx = x - chord_x * t, qy = y - chord_y * t;
    return std::sqrt(qx * qx + qy * qy);
  }

  /// True if a part that is not near is to the right of the points at its heights: of all of them or of none, since it
  /// is monotone and does not pass between them. Each of them is farther from the line between its ends than it is.
  bool is_right(const Piece& p) const {
    if (points_.low_x >= p.high_x) return false;
    if (points_.high_x < p.low_x) return true;
    const float x = middle_x_ - p.start_x, y = std::clamp(middle_y_, p.low_y, p.high_y) - p.start_y;
    return ((p.end_x - p.start_x) * y - (p.end_y - p.start_y) * x) * p.direction > 0;
  }

  const Piece* pieces_;
  LocalRectangle points_;
  float middle_x_, middle_y_;
  PieceSelection& out_;
};

}  // namespace

void select_pieces(const Program& program, const Instruction& region, const LocalRectangle& points,
                   PieceSelection& selection) {
  PieceSelector(program, points, selection)
      .select(static_cast<std::size_t>(region.end - region.first),
              [&](std::size_t i) { return region.first + static_cast<std::int32_t>(i); });
}

void select_pieces(const Program& program, const PieceSelection& around, const LocalRectangle& points,
                   PieceSelection& selection) {
  PieceSelector selector(program, points, selection);
  selector.select(around.near.size(), [&](std::size_t i) { return around.near[i]; });
  for (const std::int32_t number : around.beside) selector.count_right(number);
  selection.winding += around.winding;
}

void EvaluationStacks::select_for(const Program& program, const ShapeCode& shape, const Bounds& points) {
  constexpr std::int32_t many = 64;  // parts; fewer are selected for each evaluation
  regions.clear();
  int cells = 0;  // within a cell of a repetition, the points may be anywhere
  for (std::size_t at = shape.first; at < shape.end; ++at) {
    const Instruction& now = program.instructions()[at];
    cells += now.code == Instruction::Code::EnterCell ? 1 : now.code == Instruction::Code::LeaveCell ? -1 : 0;
    if (now.code != Instruction::Code::Region || now.end - now.first <= many || cells > 0) continue;
    LocalRectangle local{1e30f, -1e30f, 1e30f, -1e30f};
    for (const Point corner :
         {points.low, points.high, Point{points.low.x, points.high.y}, Point{points.high.x, points.low.y}}) {
      const auto p = stages::to_local<scalar::Float>(
          now.frame, {static_cast<float>(corner.x), scalar::Float(static_cast<float>(corner.y))});
      local = {std::min(local.low_x, p.x.v), std::max(local.high_x, p.x.v), std::min(local.low_y, p.y.v),
               std::max(local.high_y, p.y.v)};
    }
    check_deadline();
    regions.push_back({at, {}});
    select_pieces(program, now, local, regions.back().pieces);
  }
}

}  // namespace zoneplate::sdf
