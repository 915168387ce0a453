// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/report/plot.h"

namespace zoneplate {

void thin_labels(std::span<Curve> curves, const Axis& x, const Axis& y) {
  constexpr double letter = 0.011, line = 0.055;  // parts of the axes
  const auto part = [](const Axis& axis, double value) {
    const auto scaled = [&](double v) { return axis.is_logarithmic ? std::log(v) : v; };
    return (scaled(value) - scaled(axis.low)) / (scaled(axis.high) - scaled(axis.low));
  };
  struct Place {
    double x, y, left, right;
    std::string* label;
  };
  std::vector<Place> places;
  for (Curve& curve : curves)
    for (std::size_t i = 0; i < curve.labels.size(); ++i) {
      const double at = part(x, curve.points[i].first), width = letter * static_cast<double>(curve.labels[i].size());
      const bool is_right = curve.labels_are == Curve::Beside::RightAbove;
      places.push_back({at, part(y, curve.points[i].second), is_right ? at : at - width, is_right ? at + width : at,
                        &curve.labels[i]});
    }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& p, const Place& q) { return std::pair(p.x, p.y) < std::pair(q.x, q.y); });
  std::vector<Place> shown;
  for (const Place& p : places) {
    const auto is_under = [&](const Place& q) {
      return p.left < q.right && q.left < p.right && std::abs(p.y - q.y) < line;
    };
    if (std::ranges::any_of(shown, is_under))
      p.label->clear();
    else
      shown.push_back(p);
  }
}

}  // namespace zoneplate
