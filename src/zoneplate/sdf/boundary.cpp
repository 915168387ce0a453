// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/boundary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate::sdf {
namespace {

/// Points of the plane by number; those within a tolerance of each other are one.
class Nodes {
 public:
  explicit Nodes(double tolerance) : tolerance_(tolerance) {}

  int add(Point p) {
    const std::int64_t column = cell(p.x), row = cell(p.y);
    for (std::int64_t j = row - 1; j <= row + 1; ++j)
      for (std::int64_t i = column - 1; i <= column + 1; ++i)
        if (const auto found = cells_.find({i, j}); found != cells_.end())
          for (const int node : found->second)
            if (length(at(node) - p) <= tolerance_) return node;
    points_.push_back(p);
    const int node = static_cast<int>(points_.size()) - 1;
    cells_[{column, row}].push_back(node);
    return node;
  }
  Point at(int node) const { return points_[static_cast<std::size_t>(node)]; }
  std::size_t size() const { return points_.size(); }

 private:
  std::int64_t cell(double v) const { return static_cast<std::int64_t>(std::floor(v / (2 * tolerance_))); }

  double tolerance_;
  std::vector<Point> points_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<int>> cells_;
};

/// A point of a segment at which it meets another one.
struct Cut {
  double t;
  int node;
};

/// A segment of a contour, or a part of one, between two nodes.
struct Part {
  Segment segment;
  int from, to;
  int winding = 1;  ///< how often it is passed from `from` to `to`
};

/// A segment with the points at which others meet it.
struct Divided {
  Segment segment;
  Bounds bounds;
  int from, to;
  std::vector<Cut> cuts;
};

Segment reversed(const Segment& s) {
  Segment out{s.degree, {}};
  for (int i = 0; i <= s.degree; ++i) out.p[i] = s.p[s.degree - i];
  return out;
}

/// The zeros in (0, 1) of a t² + b t + c.
std::vector<double> zeros_within(double a, double b, double c) {
  const double d = b * b - 4 * a * c;
  if (!(d >= 0)) return {};
  const double q = -0.5 * (b + (b < 0 ? -std::sqrt(d) : std::sqrt(d)));
  std::vector<double> out;
  if (a != 0) out.push_back(q / a);
  if (q != 0) out.push_back(c / q);
  std::erase_if(out, [](double t) { return !(t > 0 && t < 1); });
  return out;
}

/// The parameters at which a curve passes its own point, and at which one along a line turns back.
std::vector<double> own_cuts(const Segment& s, double tolerance) {
  if (s.degree == 1) return {};
  // B(t) = a t³ + b t² + c t + p[0]
  const Segment cubic = s.elevated();
  const Point d1 = cubic.p[1] - cubic.p[0], d2 = cubic.p[2] - cubic.p[1], d3 = cubic.p[3] - cubic.p[2];
  const Point a = d3 - d2 * 2 + d1, b = (d2 - d1) * 3, c = d1 * 3;
  const Bounds bounds = s.bounds();
  const Point extent = bounds.high - bounds.low;
  Point farthest;
  for (int i = 1; i <= 3; ++i)
    if (length(cubic.p[i] - cubic.p[0]) > length(farthest)) farthest = cubic.p[i] - cubic.p[0];
  bool is_straight = true;
  for (int i = 1; i <= 3; ++i)
    is_straight &= std::abs(cross(farthest, cubic.p[i] - cubic.p[0])) <= tolerance * length(farthest);
  if (is_straight) {
    const auto axis = extent.x > extent.y ? &Point::x : &Point::y;
    return zeros_within(3 * (a.*axis), 2 * (b.*axis), c.*axis);
  }
  // B(s) = B(t) with u = s + t and v = s t: (u² - v) a + u b + c = 0.
  if (s.degree == 2 || cross(b, a) == 0) return {};
  const double u = -cross(c, a) / cross(b, a);
  const double v = u * u + dot(b * u + c, a) / dot(a, a);
  std::vector<double> out = zeros_within(1, -u, v);
  if (out.size() != 2) out.clear();
  return out;
}

/// The farthest that a curve is from the line between its ends, with equal parameters: an upper bound.
double bend(const Segment& s) {
  if (s.degree == 1) return 0;
  double most = 0;
  for (int i = 1; i < s.degree; ++i) most = std::max(most, length(s.p[i - 1] - s.p[i] * 2 + s.p[i + 1]));
  return most * (s.degree == 2 ? 0.25 : 0.75);
}

bool overlap(const Bounds& a, const Bounds& b, double tolerance) { return !common(a.grown(tolerance), b).empty(); }

/// How far a contour turns clockwise, or anticlockwise for around = -1: increases with the angle, from -2 for turning
/// back to 2.
double turn(Point from, Point to, int around) {
  const double across = cross(from, to) * around, along = dot(from, to), sum = std::abs(across) + std::abs(along);
  constexpr double half_turn = 1e-6;  // closer to it, rounding decides the sign of `across`
  if (sum == 0) return 0;
  if (along >= 0) return across / sum;
  return across < half_turn * sum ? -2 - across / sum : 2 - across / sum;
}

class Arrangement {
 public:
  explicit Arrangement(const Outline& outline)
      : fill_(outline.fill),
        bounds_(outline.bounds()),
        extent_(extent_of(bounds_)),
        tolerance_(extent_ * 1e-8),
        nodes_(tolerance_) {
    for (const Contour& contour : outline.contours)
      for (const Segment& s : contour) add_segment(s);
    compute_intersections();
    for (Divided& s : segments_) add_parts(s);
    merge_parts();
    count_ends();
  }

  /// Gives each part of the boundary the direction in which it winds +1 or -1 times around the region; others have 0.
  void orient(int around);
  Outline contours(int around) const;

 private:
  static double extent_of(const Bounds& b) {
    return b.empty() ? 1 : std::max({b.high.x - b.low.x, b.high.y - b.low.y, 1e-100});
  }

  void add_segment(const Segment& s) {
    std::vector<double> ends = own_cuts(s, tolerance_);
    std::ranges::sort(ends);
    ends.push_back(1);
    int from = nodes_.add(s.first());
    for (double before = 0; const double t : ends) {
      const Segment part = before == 0 && t == 1 ? s : s.part(before, t);
      const int to = nodes_.add(part.last());
      segments_.push_back({part, part.bounds(), from, to, {}});
      before = t, from = to;
    }
  }
  void cut(Divided& s, double t, int node) {
    constexpr std::size_t max_cuts = std::size_t{1} << 17;  // two for each crossing
    if (++cuts_ > max_cuts) throw Error(ErrorKind::Input, "an outline crosses itself more than 65536 times");
    s.cuts.push_back({t, node});
  }
  void compute_intersections();
  void meet_at_end(Divided& s, Point end, int node);
  void cross_parts(Divided& a, const Segment& part_a, double a0, double a1, Divided& b, const Segment& part_b,
                   double b0, double b1);
  /// False if the curves do not cross near these parameters.
  bool add_crossing(Divided& a, double s, Divided& b, double t);
  void add_parts(Divided& s);
  void merge_parts();
  void count_ends();

  /// A part of a part that is monotone along both axes.
  struct Monotone {
    Segment segment;
    Bounds bounds;
    std::size_t part;
  };
  struct Sides {
    int low = 0, high = 0;  ///< how often the contours wind around points beside a part, at lesser and greater x or y
    double clearance = 0;   ///< to the next part
  };
  Sides sides_at(std::size_t monotone, double t, bool is_across_x) const;
  bool is_inside(int winding) const { return fill_ == Outline::Fill::NonZero ? winding != 0 : winding % 2 != 0; }

  static constexpr int bands = 64;
  /// The band of a coordinate, along the outline's extent.
  int band_of(double v, double low) const {
    return static_cast<int>(std::clamp((v - low) / extent_ * bands, 0.0, bands - 1.0));
  }
  void add_monotone(const Segment& segment, std::size_t part);

  Outline::Fill fill_;
  Bounds bounds_;
  double extent_, tolerance_;
  std::size_t cuts_ = 0;
  Nodes nodes_;
  std::vector<Divided> segments_;
  std::vector<Part> parts_;
  std::vector<std::vector<std::size_t>> ends_;  ///< of each node, the parts that end or start there
  std::vector<Monotone> monotone_;
  std::array<std::vector<std::size_t>, bands> columns_, rows_;  ///< the monotone parts in each band of x, and of y
};

void Arrangement::compute_intersections() {
  // Pairs whose bounds overlap along x, by a sweep.
  std::vector<std::size_t> order(segments_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto left = [&](std::size_t i) { return segments_[i].bounds.low.x; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    check_deadline();
    Divided& a = segments_[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      Divided& b = segments_[order[j]];
      if (b.bounds.low.x > a.bounds.high.x + tolerance_) break;
      if (!overlap(a.bounds, b.bounds, tolerance_)) continue;
      meet_at_end(a, b.segment.first(), b.from), meet_at_end(a, b.segment.last(), b.to);
      meet_at_end(b, a.segment.first(), a.from), meet_at_end(b, a.segment.last(), a.to);
      cross_parts(a, a.segment, 0, 1, b, b.segment, 0, 1);
    }
  }
}

void Arrangement::meet_at_end(Divided& s, Point end, int node) {
  if (node == s.from || node == s.to || !overlap(s.bounds, {end, end}, tolerance_)) return;
  const double t = nearest_parameter(s.segment, end);
  if (length(s.segment.at(t) - end) <= tolerance_) cut(s, t, node);
}

void Arrangement::cross_parts(Divided& a, const Segment& part_a, double a0, double a1, Divided& b,
                              const Segment& part_b, double b0, double b1) {
  if (!overlap(part_a.bounds(), part_b.bounds(), tolerance_)) return;
  const double flat = extent_ * 1e-5, bend_a = bend(part_a), bend_b = bend(part_b);
  if (bend_a <= flat && bend_b <= flat) {
    const Point along_a = part_a.last() - part_a.first(), along_b = part_b.last() - part_b.first();
    const double area = cross(along_a, along_b);
    if (std::abs(area) <= 1e-14 * length(along_a) * length(along_b)) return;
    const Point offset = part_b.first() - part_a.first();
    const double s = cross(offset, along_b) / area, t = cross(offset, along_a) / area;
    // A curve may cross beside its chord.
    const double slack = a.segment.degree == 1 && b.segment.degree == 1 ? 1e-9 : 0.25;
    if (s < -slack || s > 1 + slack || t < -slack || t > 1 + slack) return;
    if (add_crossing(a, a0 + (a1 - a0) * s, b, b0 + (b1 - b0) * t)) return;
    if (bend_a <= tolerance_ && bend_b <= tolerance_) return;
  }
  if (bend_a >= bend_b) {
    const double middle = (a0 + a1) / 2;
    cross_parts(a, part_a.part(0, 0.5), a0, middle, b, part_b, b0, b1);
    cross_parts(a, part_a.part(0.5, 1), middle, a1, b, part_b, b0, b1);
  } else {
    const double middle = (b0 + b1) / 2;
    cross_parts(a, part_a, a0, a1, b, part_b.part(0, 0.5), b0, middle);
    cross_parts(a, part_a, a0, a1, b, part_b.part(0.5, 1), middle, b1);
  }
}

// Newton's method, from where the chords cross.
bool Arrangement::add_crossing(Divided& a, double s, Divided& b, double t) {
  constexpr int steps = 6;
  for (int i = 0; i < steps && a.segment.degree + b.segment.degree > 2; ++i) {
    const Point gap = b.segment.at(t) - a.segment.at(s), va = a.segment.velocity(s), vb = b.segment.velocity(t);
    const double area = cross(va, vb);
    if (area == 0) return false;
    s += cross(gap, vb) / area, t += cross(gap, va) / area;
    if (!(s > -1 && s < 2 && t > -1 && t < 2)) return false;
  }
  s = std::clamp(s, 0.0, 1.0), t = std::clamp(t, 0.0, 1.0);
  const Point p = a.segment.at(s), q = b.segment.at(t);
  if (length(p - q) > tolerance_) return false;
  const int node = nodes_.add((p + q) * 0.5);
  if (node != a.from && node != a.to) cut(a, s, node);
  if (node != b.from && node != b.to) cut(b, t, node);
  return true;
}

void Arrangement::add_parts(Divided& s) {
  std::stable_sort(s.cuts.begin(), s.cuts.end(), [](const Cut& a, const Cut& b) { return a.t < b.t; });
  double before = 0;
  int from = s.from;
  const auto add = [&](double t, int to) {
    Segment part = before == 0 && t == 1 ? s.segment : s.segment.part(before, t);
    part.p[0] = nodes_.at(from), part.p[part.degree] = nodes_.at(to);
    const Point size = part.bounds().high - part.bounds().low;
    if (from == to && std::max(size.x, size.y) <= 4 * tolerance_) return;
    parts_.push_back({part, from, to});
    before = t, from = to;
  };
  for (const Cut& c : s.cuts) add(c.t, c.node);
  add(1, s.to);
}

// Parts that lie on each other are one, which is passed several times, or as often in both directions and so never.
void Arrangement::merge_parts() {
  std::map<std::pair<int, int>, std::vector<std::size_t>> between;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    auto& others = between[std::minmax(part.from, part.to)];
    const Point middle = part.segment.at(0.5);
    const auto same = std::find_if(others.begin(), others.end(), [&](std::size_t k) {
      const Segment& other = parts_[k].segment;
      return length(other.at(nearest_parameter(other, middle)) - middle) <= 4 * tolerance_;
    });
    if (same == others.end()) {
      others.push_back(i);
      continue;
    }
    Part& other = parts_[*same];
    const double t = nearest_parameter(other.segment, middle);
    const bool is_along =
        part.from != part.to ? part.from == other.from : dot(part.segment.velocity(0.5), other.segment.velocity(t)) > 0;
    other.winding += is_along ? 1 : -1;
    part.winding = 0;
  }
  std::erase_if(parts_, [](const Part& part) { return part.winding == 0; });
}

void Arrangement::count_ends() {
  ends_.resize(nodes_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    ends_[static_cast<std::size_t>(parts_[i].from)].push_back(i);
    ends_[static_cast<std::size_t>(parts_[i].to)].push_back(i);
    for (const Segment& s : gentle_parts(parts_[i].segment)) add_monotone(s, i);
  }
}

void Arrangement::add_monotone(const Segment& segment, std::size_t part) {
  Bounds b;
  b.add(segment.first()), b.add(segment.last());
  for (int i = band_of(b.low.x, bounds_.low.x); i <= band_of(b.high.x, bounds_.low.x); ++i)
    columns_[static_cast<std::size_t>(i)].push_back(monotone_.size());
  for (int i = band_of(b.low.y, bounds_.low.y); i <= band_of(b.high.y, bounds_.low.y); ++i)
    rows_[static_cast<std::size_t>(i)].push_back(monotone_.size());
  monotone_.push_back({segment, b, part});
}

// A ray from the point towards greater x, or y, passes other parts, each of which adds its direction.
Arrangement::Sides Arrangement::sides_at(std::size_t monotone, double t, bool is_across_x) const {
  const auto across = is_across_x ? &Point::x : &Point::y, along = is_across_x ? &Point::y : &Point::x;
  const Point p = monotone_[monotone].segment.at(t);
  Sides out{.clearance = extent_};
  const auto& band = is_across_x ? rows_[static_cast<std::size_t>(band_of(p.y, bounds_.low.y))]
                                 : columns_[static_cast<std::size_t>(band_of(p.x, bounds_.low.x))];
  for (const std::size_t i : band) {
    const Monotone& m = monotone_[i];
    if (i == monotone || !(m.bounds.low.*along <= p.*along && p.*along < m.bounds.high.*along)) continue;
    const Segment& s = m.segment;
    const bool is_rising = s.last().*along > s.first().*along;
    double gap = m.bounds.low.*across - p.*across;
    if (gap <= 0 && m.bounds.high.*across >= p.*across) {
      double a = 0, b = 1;
      constexpr int steps = 50;
      if (s.degree == 1) a = b = (p.*along - s.first().*along) / (s.last().*along - s.first().*along);
      for (int k = 0; k < steps && s.degree > 1; ++k) {
        const double middle = (a + b) / 2;
        ((s.at(middle).*along < p.*along) == is_rising ? a : b) = middle;
      }
      gap = s.at((a + b) / 2).*across - p.*across;
    } else if (gap <= 0) {
      gap = m.bounds.high.*across - p.*across;
    }
    out.clearance = std::min(out.clearance, std::abs(gap));
    if (gap > 0) out.high += (is_rising ? 1 : -1) * parts_[m.part].winding;
  }
  const Segment& own = monotone_[monotone].segment;
  out.low = out.high + (own.last().*along > own.first().*along ? 1 : -1) * parts_[monotone_[monotone].part].winding;
  return out;
}

void Arrangement::orient(int around) {
  std::vector<std::size_t> first(parts_.size() + 1);  // the monotone parts of each part
  for (const Monotone& m : monotone_) ++first[m.part + 1];
  for (std::size_t i = 0; i < parts_.size(); ++i) first[i + 1] += first[i];
  const auto size = [&](std::size_t m) { return length(monotone_[m].segment.last() - monotone_[m].segment.first()); };

  std::vector<std::uint8_t> is_done(parts_.size());
  std::vector<int> oriented(parts_.size());
  for (std::size_t start = 0; start < parts_.size(); ++start) {
    if (is_done[start] != 0) continue;
    check_deadline();
    // Parts that follow each other without a meeting have the same region on each side.
    struct Link {
      std::size_t part;
      bool is_forward;
    };
    std::vector<Link> chain = {{start, true}};
    is_done[start] = 1;
    for (const bool is_forward : {true, false})
      for (Link link = chain.front();;) {
        const Part& part = parts_[link.part];
        const int node = (is_forward == link.is_forward) ? part.to : part.from;
        const auto& ends = ends_[static_cast<std::size_t>(node)];
        if (ends.size() != 2) break;
        const std::size_t next = ends[0] == link.part ? ends[1] : ends[0];
        if (is_done[next] != 0) break;
        is_done[next] = 1;
        link = {next, (parts_[next].from == node) == is_forward};
        chain.push_back(link);
      }
    // The sides of the point, of a few on the longest part, that is farthest from other parts.
    std::size_t longest = first[start];
    bool is_along = true;
    for (const Link& link : chain)
      for (std::size_t m = first[link.part]; m < first[link.part + 1]; ++m)
        if (size(m) > size(longest)) longest = m, is_along = link.is_forward;
    const Segment& s = monotone_[longest].segment;
    const Point chord = s.last() - s.first();
    const bool is_across_x = std::abs(chord.y) >= std::abs(chord.x);
    Sides sides;
    for (const double t : {0.5, 0.3, 0.7, 0.1, 0.9}) {
      const Sides found = sides_at(longest, t, is_across_x);
      if (found.clearance > sides.clearance) sides = found;
      if (sides.clearance > 1e3 * tolerance_) break;
    }
    if (is_inside(sides.low) == is_inside(sides.high)) continue;
    // With x and y exchanged, contours wind in the other direction.
    const bool is_rising = is_across_x ? chord.y > 0 : chord.x > 0;
    const int wanted = (is_inside(sides.low) ? 1 : -1) * (is_across_x ? 1 : -1) * around;
    const int direction = (is_rising ? 1 : -1) * wanted * (is_along ? 1 : -1);
    for (const Link& link : chain) oriented[link.part] = link.is_forward ? direction : -direction;
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].winding = oriented[i];
}

Outline Arrangement::contours(int around) const {
  Outline out;
  std::vector<std::uint8_t> is_used(parts_.size());
  const auto start_of = [&](std::size_t i) { return parts_[i].winding > 0 ? parts_[i].from : parts_[i].to; };
  const auto directed = [&](std::size_t i) {
    return parts_[i].winding > 0 ? parts_[i].segment : reversed(parts_[i].segment);
  };
  for (std::size_t start = 0; start < parts_.size(); ++start) {
    if (is_used[start] != 0 || parts_[start].winding == 0) continue;
    Contour contour;
    for (std::size_t i = start;;) {
      is_used[i] = 1;
      contour.push_back(directed(i));
      const int node = parts_[i].winding > 0 ? parts_[i].to : parts_[i].from;
      // Of several contours that touch here, this one turns the most towards the region.
      const Point before = contour.back().direction_at_end();
      std::size_t next = parts_.size();
      double best = -3;
      for (const std::size_t k : ends_[static_cast<std::size_t>(node)]) {
        if (parts_[k].winding == 0 || start_of(k) != node || (is_used[k] != 0 && k != start)) continue;
        const double angle = turn(before, directed(k).direction_at_start(), around);
        if (angle > best) best = angle, next = k;
      }
      if (next == start || next == parts_.size()) break;
      i = next;
    }
    if (contour.back().last() != contour.front().first())
      contour.push_back({1, {contour.back().last(), contour.front().first()}});
    out.contours.push_back(std::move(contour));
  }
  return out;
}

}  // namespace

double signed_area(const Outline& outline) {
  double area = 0;
  for (const Contour& contour : outline.contours)
    for (const Segment& s : contour)
      for (int i = 0; i < s.degree; ++i) area += cross(s.p[i], s.p[i + 1]);
  return area;
}

Outline boundary_of(const Outline& outline) {
  const int around = signed_area(outline) < 0 ? -1 : 1;
  Arrangement arrangement(outline);
  arrangement.orient(around);
  return arrangement.contours(around);
}

}  // namespace zoneplate::sdf
