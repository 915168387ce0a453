// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/outline.h"

#include <algorithm>
#include <array>

namespace zoneplate::sdf {
namespace {

constexpr Point mix(Point a, Point b, double t) { return a + (b - a) * t; }

/// The zeros in (0, 1) of one coordinate of the velocity, which is a line or a parabola.
void add_extrema(const Segment& s, double Point::*axis, std::vector<double>& out) {
  const double v0 = s.velocity(0).*axis, v1 = s.velocity(1).*axis, vm = s.velocity(0.5).*axis;
  // v(t) = a t² + b t + v0
  const double a = 2 * (v0 + v1 - 2 * vm), b = v1 - v0 - a, d = b * b - 4 * a * v0;
  if (d < 0) return;
  const double q = -0.5 * (b + (b < 0 ? -std::sqrt(d) : std::sqrt(d)));
  if (a != 0) out.push_back(q / a);
  if (q != 0) out.push_back(v0 / q);
}

/// True if consecutive legs of the control polygon turn by at most about 30°.
bool is_gentle(const Segment& s) {
  constexpr double cosine = 0.866;
  for (int i = 1; i < s.degree; ++i) {
    const Point a = s.p[i] - s.p[i - 1], b = s.p[i + 1] - s.p[i];
    if (dot(a, b) < cosine * length(a) * length(b)) return false;
  }
  const Point chord = s.last() - s.first(), out = s.p[1] - s.first();
  return length(out) > 0 && length(s.last() - s.p[s.degree - 1]) > 0 &&
         dot(chord, out) >= cosine * length(chord) * length(out);
}

void divide(const Segment& s, int depth, std::vector<Segment>& out) {
  constexpr int deepest = 10;
  if (s.degree == 1 || is_gentle(s)) {
    out.push_back(s);
  } else if (depth == deepest) {
    if (s.first() != s.last()) out.push_back({1, {s.first(), s.last()}});
  } else {
    divide(s.part(0, 0.5), depth + 1, out);
    divide(s.part(0.5, 1), depth + 1, out);
  }
}

}  // namespace

Point Segment::at(double t) const {
  if (degree == 1) return mix(p[0], p[1], t);
  const Point ab = mix(p[0], p[1], t), bc = mix(p[1], p[2], t);
  if (degree == 2) return mix(ab, bc, t);
  return mix(mix(ab, bc, t), mix(bc, mix(p[2], p[3], t), t), t);
}

Point Segment::velocity(double t) const {
  if (degree == 1) return p[1] - p[0];
  const Point a = p[1] - p[0], b = p[2] - p[1];
  if (degree == 2) return mix(a, b, t) * 2;
  return mix(mix(a, b, t), mix(b, p[3] - p[2], t), t) * 3;
}

Point Segment::acceleration(double t) const {
  if (degree == 1) return {};
  const Point a = p[2] - p[1] * 2 + p[0];
  if (degree == 2) return a * 2;
  return mix(a, p[3] - p[2] * 2 + p[1], t) * 6;
}

Point Segment::direction_at_start() const {
  for (int i = 1; i <= degree; ++i)
    if (p[i] != p[0]) return p[i] - p[0];
  return {};
}

Point Segment::direction_at_end() const {
  for (int i = degree; i-- > 0;)
    if (p[i] != p[degree]) return p[degree] - p[i];
  return {};
}

// The blossom: control point i takes b as i of its arguments and a as the others.
Segment Segment::part(double a, double b) const {
  Segment out{degree, {}};
  for (int i = 0; i <= degree; ++i) {
    std::array<Point, 4> q = {p[0], p[1], p[2], p[3]};
    for (int level = degree; level > 0; --level)
      for (int k = 0; k < level; ++k)
        q[static_cast<std::size_t>(k)] =
            mix(q[static_cast<std::size_t>(k)], q[static_cast<std::size_t>(k) + 1], level <= i ? b : a);
    out.p[i] = q[0];
  }
  if (a == 0) out.p[0] = p[0];
  if (b == 1) out.p[degree] = p[degree];
  return out;
}

Segment Segment::elevated() const {
  if (degree == 3) return *this;
  if (degree == 2) return {3, {p[0], mix(p[0], p[1], 2.0 / 3), mix(p[2], p[1], 2.0 / 3), p[2]}};
  return {3, {p[0], mix(p[0], p[1], 1.0 / 3), mix(p[0], p[1], 2.0 / 3), p[1]}};
}

Bounds Segment::bounds() const {
  Bounds out;
  for (int i = 0; i <= degree; ++i) out.add(p[i]);
  return out;
}

Bounds Outline::bounds() const {
  Bounds out;
  for (const Contour& contour : contours)
    for (const Segment& s : contour) out.add(s.bounds());
  return out;
}

std::size_t Outline::size() const {
  std::size_t count = 0;
  for (const Contour& contour : contours) count += contour.size();
  return count;
}

Outline Outline::mapped(const Similarity& map) const {
  Outline out = *this;
  for (Contour& contour : out.contours)
    for (Segment& s : contour)
      for (int i = 0; i <= s.degree; ++i) s.p[i] = map(s.p[i]);
  return out;
}

void Pen::add(const Segment& segment) {
  bool moves = false;
  for (int i = 1; i <= segment.degree; ++i) moves |= segment.p[i] != segment.p[0];
  if (moves) contour_.push_back(segment);
  at_ = segment.last();
}

void Pen::move_to(Point p) {
  close();
  start_ = at_ = p;
}
void Pen::line_to(Point p) { add({1, {at_, p}}); }
void Pen::quadratic_to(Point control, Point p) { add({2, {at_, control, p}}); }
void Pen::cubic_to(Point control1, Point control2, Point p) { add({3, {at_, control1, control2, p}}); }

void Pen::close() {
  if (contour_.empty()) return;
  if (at_ != start_) line_to(start_);
  outline_.contours.push_back(std::move(contour_));
  contour_.clear();
}

Outline polygon(std::span<const Point> points) {
  Outline out;
  Pen pen(out);
  for (std::size_t i = 0; i < points.size(); ++i) i == 0 ? pen.move_to(points[0]) : pen.line_to(points[i]);
  pen.close();
  return out;
}

std::vector<Segment> gentle_parts(const Segment& segment) {
  if (segment.degree == 1) return {segment};
  std::vector<double> cuts = {0, 1};
  add_extrema(segment, &Point::x, cuts);
  add_extrema(segment, &Point::y, cuts);
  std::erase_if(cuts, [](double t) { return !(t >= 0 && t <= 1) || (t != 0 && t < 1e-9) || (t != 1 && t > 1 - 1e-9); });
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::vector<Segment> out;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    Segment part = segment.part(cuts[i - 1], cuts[i]);
    if (!out.empty()) part.p[0] = out.back().last();
    divide(part, 0, out);
  }
  // Each part starts exactly where the one before ends, so that a ray never passes between two.
  for (std::size_t i = 1; i < out.size(); ++i) out[i].p[0] = out[i - 1].last();
  return out;
}

double nearest_parameter(const Segment& segment, Point p) {
  const auto distance2 = [&](double t) {
    const Point d = segment.at(t) - p;
    return dot(d, d);
  };
  if (segment.degree == 1) {
    const Point along = segment.last() - segment.first();
    const double square = dot(along, along);
    return square > 0 ? std::clamp(dot(p - segment.first(), along) / square, 0.0, 1.0) : 0.0;
  }
  // Half of the squared distance has the derivative (B - p) · B'; a minimum is where it rises through 0.
  constexpr int intervals = 32, steps = 60;
  const auto slope = [&](double t) { return dot(segment.at(t) - p, segment.velocity(t)); };
  double best = distance2(1) < distance2(0) ? 1.0 : 0.0;
  double before = slope(0);
  for (int i = 0; i < intervals; ++i) {
    double a = static_cast<double>(i) / intervals, b = static_cast<double>(i + 1) / intervals;
    const double after = slope(b);
    if (before < 0 && after >= 0) {
      for (int k = 0; k < steps && b - a > 1e-15; ++k) {
        const double middle = (a + b) / 2;
        (slope(middle) < 0 ? a : b) = middle;
      }
      if (distance2(b) < distance2(best)) best = b;
    }
    before = after;
  }
  return best;
}

}  // namespace zoneplate::sdf
