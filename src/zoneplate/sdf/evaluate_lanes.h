// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/sdf/evaluate.h"

/// The kernels of sdf/evaluate.h, over the lane types of math/lanes.h.
namespace zoneplate::sdf::stages {

template <class F>
struct LanePoint {
  F x, y;
};

/// A distance and its gradient.
template <class F>
struct LaneValue {
  F d, x, y;

  [[gnu::always_inline]] static LaneValue load(const DistanceBatch& b, int i) {
    return {F::load(b.d + i), F::load(b.x + i), F::load(b.y + i)};
  }
  [[gnu::always_inline]] void store(DistanceBatch& b, int i) const {
    d.store(b.d + i), x.store(b.x + i), y.store(b.y + i);
  }
  [[gnu::always_inline]] LaneValue operator-() const { return {-d, -x, -y}; }
  [[gnu::always_inline]] friend LaneValue select(typename F::Bool m, LaneValue a, LaneValue b) {
    return {select(m, a.d, b.d), select(m, a.x, b.x), select(m, a.y, b.y)};
  }
};

/// The sign of v as 1 or -1.
template <class F>
[[gnu::always_inline]] inline F sign_of(F v) {
  return select(v < F(0.0f), F(-1.0f), F(1.0f));
}

/// The value at offset (x, y) from the nearest point of the boundary; any direction where the offset is 0.
template <class F>
[[gnu::always_inline]] inline LaneValue<F> value_of_offset(F x, F y, F sign) {
  const F distance = sqrt(x * x + y * y);
  const typename F::Bool has_direction = distance > F(0.0f);
  const F inverse = sign / select(has_direction, distance, F(1.0f));
  return {distance * sign, select(has_direction, x * inverse, F(1.0f)), select(has_direction, y * inverse, F(0.0f))};
}

template <class F>
[[gnu::always_inline]] inline LanePoint<F> to_local(const LocalFrame& f, LanePoint<F> p) {
  const F x = p.x - F(f.move_x), y = p.y - F(f.move_y);
  return {(F(f.cosine) * x + F(f.sine) * y) * F(f.inverse_scale),
          (F(f.cosine) * y - F(f.sine) * x) * F(f.mirror * f.inverse_scale)};
}

template <class F>
[[gnu::always_inline]] inline LaneValue<F> from_local(const LocalFrame& f, LaneValue<F> v) {
  const F y = v.y * F(f.mirror);
  return {v.d * F(f.scale), F(f.cosine) * v.x - F(f.sine) * y, F(f.sine) * v.x + F(f.cosine) * y};
}

template <class F>
[[gnu::always_inline]] inline LaneValue<F> circle_value(const Instruction& shape, LanePoint<F> p) {
  LaneValue<F> v = value_of_offset<F>(p.x, p.y, F(1.0f));
  v.d = v.d - F(shape.a);
  return v;
}

template <class F>
[[gnu::always_inline]] inline LaneValue<F> rectangle_value(const Instruction& shape, LanePoint<F> p) {
  const F zero(0.0f), one(1.0f), sx = sign_of(p.x), sy = sign_of(p.y);
  const F x = abs(p.x) - F(shape.a), y = abs(p.y) - F(shape.b);
  LaneValue<F> out = value_of_offset<F>(max(x, zero), max(y, zero), one);
  const typename F::Bool is_wide = x > y;
  const LaneValue<F> in{max(x, y), select(is_wide, one, zero), select(is_wide, zero, one)};
  out = select(max(x, y) > zero, out, in);
  return {out.d, out.x * sx, out.y * sy};
}

/// A lower bound of the t > 0 at which (n / (t + k))² + (z / t)² is 1, within a factor of 1.6 of it.
///
/// The bounds are that of each term alone, and of t² (t + k - n) ≥ k z² / 2, which holds because
/// 1 - (n / (t + k))² ≤ 2 (t + k - n) / k. The latter is near where many points of the ellipse are nearly as near: at
/// the cusps of its evolute.
template <class F>
[[gnu::always_inline]] inline F ellipse_bound(F n, float k, F z) {
  const F zero(0.0f), half(0.5f), least(1e-37f), behind = F(k) - n, volume = max(F(0.5f * k) * z * z, least);
  const F root = exp2(log2(volume) * F(1.0f / 3));
  constexpr float half_root = 0.79f, rounding = 0.9999f;  // the cube root of 1/2
  const F cusp =
      select(behind > zero, min(sqrt(volume * half / max(behind, least)), root * F(half_root)), root * F(rounding));
  return max(max(z, n - F(k)), cusp);
}

/// The nearest point of an ellipse with the radii a ≥ b has the coordinates a² x / (s + a²) and b² y / (s + b²), where
/// the sum of their squares in units of the radii is 1. With s = b² (t - 1) that is ellipse_bound's equation; Newton's
/// method on 1 / √(sum), which is nearly linear in t, rises to its root from below.
///
/// Exact     five steps: within 3e-7 of the greater radius and of the point's distance, for a / b up to 10⁵.
/// Source    the equation: Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid, 2013; the
///           method: Moré and Sorensen, Computing a Trust Region Step, 1983.
template <class F>
[[gnu::always_inline]] inline LaneValue<F> ellipse_value(const Instruction& shape, LanePoint<F> p) {
  constexpr int steps = 5;
  const bool is_wide = shape.a >= shape.b;
  const float a = is_wide ? shape.a : shape.b, b = is_wide ? shape.b : shape.a;
  const F px = abs(is_wide ? p.x : p.y), py = abs(is_wide ? p.y : p.x), one(1.0f);
  const float inverse = 1 / b, k = (a - b) * inverse * ((a + b) * inverse);
  // On the long axis the nearest point may lie above or below: the point is moved off it by much less than rounding.
  const F n = px * F(a * inverse * inverse), z = max(py * F(inverse), F(1e-18f));
  const F low = ellipse_bound(n, k, z);
  F t = low;
  for (int i = 0; i < steps; ++i) {
    const F inverse_t = one / t, inverse_s = one / (t + F(k));
    const F x = n * inverse_s, y = z * inverse_t, xx = x * x, yy = y * y, sum = xx + yy;
    t = max(t + (sqrt(sum) - one) * sum / (xx * inverse_s + yy * inverse_t), low);
  }
  const F x = n / (t + F(k)), y = z / t, norm = one / sqrt(x * x + y * y);
  // Inside, the sign is that of the implicit equation.
  const F nx = px / F(a), ny = py / F(b);
  const F sign = select(nx * nx + ny * ny < one, F(-1.0f), one);
  const LaneValue<F> v = value_of_offset<F>(px - F(a) * (x * norm), py - F(b) * (y * norm), sign);
  return {v.d, (is_wide ? v.x : v.y) * sign_of(p.x), (is_wide ? v.y : v.x) * sign_of(p.y)};
}

/// The nearest point so far among the parts of an outline, and the winding number.
template <class F>
struct RegionState {
  F square, x, y, winding;
};

/// True if the part's half-open range of heights contains the point.
template <class F>
[[gnu::always_inline]] inline typename F::Bool is_at_height(const Piece& piece, LanePoint<F> p) {
  return (p.y >= F(piece.low_y)) & (p.y < F(piece.high_y));
}

/// Counts a part that a ray to the right crosses: one at the height of the point, and to its right. `is_right` decides
/// where the point lies within the part's bounds.
template <class F>
[[gnu::always_inline]] inline void count_crossing(const Piece& piece, LanePoint<F> p, typename F::Bool is_right,
                                                  RegionState<F>& state) {
  const typename F::Bool crosses =
      is_at_height<F>(piece, p) & (p.x < F(piece.high_x)) & ((p.x < F(piece.low_x)) | is_right);
  state.winding = state.winding + where(crosses, F(piece.direction));
}

template <class F, bool is_line>
[[gnu::always_inline]] inline void add_piece(const Piece& piece, LanePoint<F> p, RegionState<F>& state) {
  const F zero(0.0f), one(1.0f);
  const F x = p.x - F(piece.start_x), y = p.y - F(piece.start_y);
  const F chord_x(piece.end_x - piece.start_x), chord_y(piece.end_y - piece.start_y);
  F t = min(max((x * chord_x + y * chord_y) * F(piece.inverse_square), zero), one);
  F qx, qy, vx, vy;  // the point relative to the nearest one of the part, and the velocity there
  if constexpr (is_line) {
    qx = x - chord_x * t, qy = y - chord_y * t;
    vx = chord_x, vy = chord_y;
  } else {
    // The derivative of half of the squared distance is q · v; its own derivative is kept at a quarter of |v|² at
    // least, so that every step descends.
    constexpr int steps = 9;
    const F ax(piece.a_x), ay(piece.a_y), bx(piece.b_x), by(piece.b_y), cx(piece.c_x), cy(piece.c_y);
    const auto look = [&] {
      qx = x - ((ax * t + bx) * t + cx) * t, qy = y - ((ay * t + by) * t + cy) * t;
      vx = (F(3.0f) * ax * t + F(2.0f) * bx) * t + cx, vy = (F(3.0f) * ay * t + F(2.0f) * by) * t + cy;
    };
    look();
    for (int k = 0; k < steps; ++k) {
      const F wx = F(6.0f) * ax * t + F(2.0f) * bx, wy = F(6.0f) * ay * t + F(2.0f) * by;
      const F speed = vx * vx + vy * vy;
      const F slope = max(speed - (qx * wx + qy * wy), speed * F(0.25f));
      t = min(max(t + (qx * vx + qy * vy) / max(slope, F(1e-30f)), zero), one);
      look();
    }
  }
  // A point of the boundary counts as one that is moved aside by next to nothing, so that it has a direction.
  constexpr float aside = 1e-16f;
  qx = qx + vy * F(aside), qy = qy - vx * F(aside);
  const F square = qx * qx + qy * qy;
  const typename F::Bool is_nearer = square < state.square;
  state.square = select(is_nearer, square, state.square);
  state.x = select(is_nearer, qx, state.x), state.y = select(is_nearer, qy, state.y);
  // Within its bounds, the part is to the right of the point if it passes the point on the side that its direction
  // says.
  count_crossing<F>(piece, p, (vx * qy - vy * qx) * F(piece.direction) > zero, state);
}

template <class F>
[[gnu::always_inline]] inline LaneValue<F> region_value(const Program& program, const Instruction& region,
                                                        const PieceSelection& selection, LanePoint<F> p) {
  const Piece* const pieces = program.pieces().data();
  RegionState<F> state{F(1e30f), F(1e15f), F(0.0f), F(selection.winding)};
  for (const std::int32_t i : selection.near) {
    if (i < region.curves)
      add_piece<F, true>(pieces[i], p, state);
    else
      add_piece<F, false>(pieces[i], p, state);
  }
  for (const std::int32_t i : selection.beside)
    state.winding = state.winding + where(is_at_height<F>(pieces[i], p), F(pieces[i].direction));
  F winding = state.winding;
  if (region.is_even_odd) winding = winding - F(2.0f) * floor(winding * F(0.5f));
  return value_of_offset<F>(state.x, state.y, select(winding == F(0.0f), F(1.0f), F(-1.0f)));
}

/// The least of two distances, minus the height of a parabola that joins them smoothly where they differ by less than
/// k.
template <class F>
[[gnu::always_inline]] inline LaneValue<F> smooth_union_of(LaneValue<F> a, LaneValue<F> b, float k) {
  const typename F::Bool first = a.d < b.d;
  const LaneValue<F> low = select(first, a, b), high = select(first, b, a);
  const F h = max(F(k) - (high.d - low.d), F(0.0f)) * F(1 / k), half = h * F(0.5f);
  return {low.d - h * h * F(k / 4), low.x + (high.x - low.x) * half, low.y + (high.y - low.y) * half};
}

template <class F>
[[gnu::always_inline]] inline LaneValue<F> joined(const Instruction& instruction, LaneValue<F> a, LaneValue<F> b) {
  using Code = Instruction::Code;
  const bool is_smooth = instruction.a > 0;
  switch (instruction.code) {
    case Code::SmoothUnion:
      if (is_smooth) return smooth_union_of<F>(a, b, instruction.a);
      [[fallthrough]];
    case Code::Union:
      return select(b.d < a.d, b, a);
    case Code::SmoothIntersection:
      if (is_smooth) return -smooth_union_of<F>(-a, -b, instruction.a);
      [[fallthrough]];
    case Code::Intersection:
      return select(b.d > a.d, b, a);
    case Code::SmoothDifference:
      if (is_smooth) return -smooth_union_of<F>(-a, b, instruction.a);
      [[fallthrough]];
    default:
      return select(-b.d > a.d, -b, a);
  }
}

/// The coordinate relative to the middle of the nearest cell along one axis, or of the second nearest.
template <class F>
[[gnu::always_inline]] inline F in_cell(F p, float step, float count, bool is_second) {
  if (step <= 0) return p;
  const float centre = count > 0 ? (count - 1) * 0.5f : 0.0f;
  const F u = p * F(1 / step) + F(centre);
  F cell = floor(u + F(0.5f));
  if (is_second) cell = cell + select(u < cell, F(-1.0f), F(1.0f));
  if (count > 0) cell = min(max(cell, F(0.0f)), F(count - 1));
  return p - (cell - F(centre)) * F(step);
}

/// Selects the parts of an outline for the points, from `around` if it is not null.
template <class F>
void select_for(const Program& program, const Instruction& region, const PointBatch& points,
                const PieceSelection* around, PieceSelection& out) {
  F low_x(1e30f), low_y(1e30f), high_x(-1e30f), high_y(-1e30f);
  for (int i = points.begin; i < points.end; i += F::lanes) {
    const LanePoint<F> p = to_local<F>(region.frame, {F::load(points.x + i), F::load(points.y + i)});
    low_x = min(low_x, p.x), low_y = min(low_y, p.y), high_x = max(high_x, p.x), high_y = max(high_y, p.y);
  }
  const LocalRectangle rectangle{-greatest(-low_x), greatest(high_x), -greatest(-low_y), greatest(high_y)};
  if (around)
    select_pieces(program, *around, rectangle, out);
  else
    select_pieces(program, region, rectangle, out);
}

template <class F>
void evaluate(const Program& program, const ShapeCode& shape, const PointBatch& points, EvaluationStacks& stacks) {
  using Code = Instruction::Code;
  DistanceBatch* top = stacks.values.data() - 1;
  PointBatch* frame = stacks.frames.data();
  *frame = points;
  auto selected = stacks.regions.cbegin();
  for (std::size_t at = shape.first; at < shape.end; ++at) {
    const Instruction& now = program.instructions()[at];
    const auto for_points = [&](const auto& value) {
      for (int i = points.begin; i < points.end; i += F::lanes) {
        const LanePoint<F> p = to_local<F>(now.frame, {F::load(frame->x + i), F::load(frame->y + i)});
        from_local<F>(now.frame, value(p)).store(*top, i);
      }
    };
    switch (now.code) {
      case Code::Circle:
        ++top;
        for_points([&](LanePoint<F> p) { return circle_value<F>(now, p); });
        break;
      case Code::Ellipse:
        ++top;
        for_points([&](LanePoint<F> p) { return ellipse_value<F>(now, p); });
        break;
      case Code::Rectangle:
        ++top;
        for_points([&](LanePoint<F> p) { return rectangle_value<F>(now, p); });
        break;
      case Code::Region:
        ++top;
        if (selected != stacks.regions.cend() && selected->instruction == at)
          select_for<F>(program, now, *frame, &(selected++)->pieces, stacks.selection);
        else
          select_for<F>(program, now, *frame, nullptr, stacks.selection);
        for_points([&](LanePoint<F> p) { return region_value<F>(program, now, stacks.selection, p); });
        break;
      case Code::EnterCell:
        for (int i = points.begin; i < points.end; i += F::lanes) {
          const LanePoint<F> p = to_local<F>(now.frame, {F::load(frame->x + i), F::load(frame->y + i)});
          in_cell<F>(p.x, now.a, now.count_x, now.cell & 1).store(frame[1].x + i);
          in_cell<F>(p.y, now.b, now.count_y, now.cell & 2).store(frame[1].y + i);
        }
        frame[1].begin = points.begin, frame[1].end = points.end;
        ++frame;
        break;
      case Code::LeaveCell:
        --frame;
        for (int i = points.begin; i < points.end; i += F::lanes)
          from_local<F>(now.frame, LaneValue<F>::load(*top, i)).store(*top, i);
        break;
      case Code::Store:
      case Code::Load: {
        DistanceBatch& kept = stacks.kept[static_cast<std::size_t>(now.first)];
        const bool is_store = now.code == Code::Store;
        if (!is_store) ++top;
        for (int i = points.begin; i < points.end; i += F::lanes)
          LaneValue<F>::load(is_store ? *top : kept, i).store(is_store ? kept : *top, i);
        break;
      }
      case Code::Offset:
        for (int i = points.begin; i < points.end; i += F::lanes) (F::load(top->d + i) - F(now.a)).store(top->d + i);
        break;
      case Code::Border:
        for (int i = points.begin; i < points.end; i += F::lanes) {
          const LaneValue<F> v = LaneValue<F>::load(*top, i);
          LaneValue<F> out = select(v.d < F(0.0f), -v, v);
          out.d = out.d - F(now.a * 0.5f);
          out.store(*top, i);
        }
        break;
      case Code::Complement:
        for (int i = points.begin; i < points.end; i += F::lanes) (-LaneValue<F>::load(*top, i)).store(*top, i);
        break;
      default:
        --top;
        for (int i = points.begin; i < points.end; i += F::lanes)
          joined<F>(now, LaneValue<F>::load(top[0], i), LaneValue<F>::load(top[1], i)).store(*top, i);
    }
  }
}

template <class F>
void add_coverage(const PointBatch& points, const DistanceBatch& values, float inverse_footprint, float weight,
                  float* coverage) {
  const F zero(0.0f), one(1.0f), half(0.5f);
  for (int i = points.begin; i < points.end; i += F::lanes) {
    const LaneValue<F> v = LaneValue<F>::load(values, i);
    // To first order, the boundary of a distance of slope s is at distance d / s.
    const F inverse_slope = one / max(sqrt(v.x * v.x + v.y * v.y), F(1e-3f));
    const F nx = abs(v.x) * inverse_slope, ny = abs(v.y) * inverse_slope;
    const F d = v.d * inverse_slope * F(inverse_footprint), depth = abs(d);
    // The area beyond a line, as a function of its distance, has the density of the sum of two uniform variables of
    // widths |nx| and |ny|: a trapezoid, flat to (wide - narrow) / 2, then linear to zero at (wide + narrow) / 2.
    const F wide = max(max(nx, ny), F(1e-3f)), narrow = min(nx, ny);
    const F rest = max((wide + narrow) * half - depth, zero);
    const F inner = half + depth / wide;
    const F outer = one - rest * rest / max(F(2.0f) * wide * narrow, F(1e-30f));
    const F larger = select(depth > (wide - narrow) * half, outer, inner);
    const F area = select(d < zero, larger, one - larger);
    (F::load(coverage + i) + area * F(weight)).store(coverage + i);
  }
}

template <class F>
void composite(const PointBatch& points, const float* coverage, const float color[4], float* const planes[4]) {
  for (int i = points.begin; i < points.end; i += F::lanes) {
    const F k = F::load(coverage + i);
    const F rest = F(1.0f) - F(color[3]) * k;
    for (int c = 0; c < 4; ++c) (F(color[c]) * k + F::load(planes[c] + i) * rest).store(planes[c] + i);
  }
}

template <class F>
constexpr CoverageKernels coverage_kernels() {
  return {.evaluate = &evaluate<F>, .add_coverage = &add_coverage<F>, .composite = &composite<F>};
}

}  // namespace zoneplate::sdf::stages
