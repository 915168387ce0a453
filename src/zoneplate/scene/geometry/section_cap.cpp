// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/section_cap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>

#include "zoneplate/math/double3.h"

namespace zoneplate {
namespace {

/// A place in the plane, along its axes.
struct PlanePoint {
  double u = 0, v = 0;
  auto operator<=>(const PlanePoint&) const = default;
};

/// The axes of the plane: a right-handed system with the normal.
class PlaneAxes {
 public:
  PlaneAxes(double3 normal, float3 origin) : origin_(widened(origin)) {
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    const double3 other = x <= y && x <= z ? double3{1, 0, 0} : y <= z ? double3{0, 1, 0} : double3{0, 0, 1};
    const double3 side = cross(other, normal);
    u_ = side * (1 / std::sqrt(dot(side, side)));
    v_ = cross(normal, u_);
  }
  PlanePoint of(float3 p) const { return {dot(widened(p) - origin_, u_), dot(widened(p) - origin_, v_)}; }
  float3 place(PlanePoint p) const { return narrowed(origin_ + u_ * p.u + v_ * p.v); }

 private:
  double3 origin_, u_, v_;
};

/// Ends of segments by their places, numbered.
class OutlineCorners {
 public:
  std::uint32_t of(float3 p) {
    const auto [found, is_new] = number_.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(number_.size()));
    return found->second;
  }
  std::size_t count() const { return number_.size(); }

 private:
  std::map<std::tuple<float, float, float>, std::uint32_t> number_;
};

/// The segments of closed outlines.
std::vector<OutlineSegment> closed_outlines(const std::vector<OutlineSegment>& segments) {
  OutlineCorners corners;
  std::vector<std::array<std::uint32_t, 2>> ends;
  for (const OutlineSegment& s : segments) ends.push_back({corners.of(s.from), corners.of(s.to)});
  std::vector<int> balance(corners.count(), 0);
  std::vector<std::uint32_t> parent(corners.count());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [from, to] : ends) {
    ++balance[from], --balance[to];
    parent[root(from)] = root(to);
  }
  std::vector<std::uint8_t> is_open(corners.count(), 0);
  for (std::uint32_t i = 0; i < balance.size(); ++i)
    if (balance[i] != 0) is_open[root(i)] = 1;
  std::vector<OutlineSegment> out;
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (is_open[root(ends[i][0])] == 0) out.push_back(segments[i]);
  return out;
}

/// A segment that rises along v.
struct Rise {
  PlanePoint low, high;
  int winding;  ///< 1 if the outline falls along it: its inside is at greater u
  double u_at(double v) const {
    if (v <= low.v) return low.u;
    if (v >= high.v) return high.u;
    return low.u + (high.u - low.u) * ((v - low.v) / (high.v - low.v));
  }
};

/// The corners on a line of constant v from left to right: the ends and all corners between.
std::vector<PlanePoint> slab_side(double left, double right, double v, std::span<const PlanePoint> on_line) {
  std::vector<PlanePoint> out = {{left, v}};
  for (const PlanePoint& p : on_line)
    if (p.u > left && p.u < right) out.push_back(p);
  out.push_back({right, v});
  return out;
}

}  // namespace

std::vector<std::array<float3, 3>> fill_outlines(const std::vector<OutlineSegment>& segments, double3 normal) {
  const std::vector<OutlineSegment> outlines = closed_outlines(segments);
  std::vector<std::array<float3, 3>> out;
  if (outlines.empty()) return out;
  const PlaneAxes axes(normal, outlines.front().from);
  std::vector<Rise> rises;
  std::vector<PlanePoint> corners;  // by v, then u
  for (const OutlineSegment& s : outlines) {
    const PlanePoint from = axes.of(s.from), to = axes.of(s.to);
    corners.push_back(from);
    if (from.v < to.v) rises.push_back({from, to, -1});
    if (from.v > to.v) rises.push_back({to, from, 1});
  }
  std::ranges::sort(corners,
                    [](const PlanePoint& a, const PlanePoint& b) { return std::tie(a.v, a.u) < std::tie(b.v, b.u); });
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::ranges::sort(rises, [](const Rise& a, const Rise& b) {
    return std::tie(a.low.v, a.low.u, a.high.v, a.high.u, a.winding) <
           std::tie(b.low.v, b.low.u, b.high.v, b.high.u, b.winding);
  });
  const auto add = [&](PlanePoint a, PlanePoint b, PlanePoint c) {
    out.push_back({axes.place(a), axes.place(b), axes.place(c)});
  };

  // One slab between neighbouring values of v after the other, with the segments that cross it.
  std::vector<Rise> active;
  std::size_t next = 0, line = 0;
  while (line < corners.size()) {
    const double v = corners[line].v;
    std::size_t line_end = line;
    while (line_end < corners.size() && corners[line_end].v == v) ++line_end;
    if (line_end == corners.size()) break;
    const double above = corners[line_end].v, middle = v + (above - v) / 2;
    std::size_t above_end = line_end;
    while (above_end < corners.size() && corners[above_end].v == above) ++above_end;
    std::erase_if(active, [&](const Rise& r) { return r.high.v <= v; });
    for (; next < rises.size() && rises[next].low.v <= v; ++next)
      if (rises[next].high.v > v) active.push_back(rises[next]);
    std::stable_sort(active.begin(), active.end(),  // the library of Emscripten has none of ranges
                     [&](const Rise& a, const Rise& b) { return a.u_at(middle) < b.u_at(middle); });
    int winding = 0;
    for (std::size_t left = 0, i = 0; i < active.size(); ++i) {
      if (winding == 0) left = i;
      winding += active[i].winding;
      if (winding != 0) continue;
      const std::span<const PlanePoint> all(corners);
      const std::vector<PlanePoint> below =
          slab_side(active[left].u_at(v), active[i].u_at(v), v, all.subspan(line, line_end - line));
      const std::vector<PlanePoint> over = slab_side(active[left].u_at(above), active[i].u_at(above), above,
                                                     all.subspan(line_end, above_end - line_end));
      // Two fans make the trapezoid: of the lower side about the upper left corner, and of the upper side about the
      // lower right one.
      for (std::size_t k = 0; k + 1 < below.size(); ++k)
        if (below[k].u < below[k + 1].u) add(over.front(), below[k], below[k + 1]);
      for (std::size_t k = 0; k + 1 < over.size(); ++k)
        if (over[k].u < over[k + 1].u) add(below.back(), over[k + 1], over[k]);
    }
    line = line_end;
  }
  return out;
}

}  // namespace zoneplate
