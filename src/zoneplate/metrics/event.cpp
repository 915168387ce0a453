// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/event.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

constexpr double min_change = 0.125, max_rest = 1.0 / 64;  // codes
constexpr double min_share = 0.001;                        // of the pixels

double max_difference(Display a, Display b) {
  const Codes p = codes_on_black(a), q = codes_on_black(b);
  return std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
}

bool is_event(Frames reference, int x, int y) {
  const auto code = [&](std::size_t frame) { return reference[frame].display(x, y); };
  if (!(max_difference(code(0), code(1)) > min_change)) return false;
  for (std::size_t frame = 2; frame < reference.size(); ++frame)
    if (max_difference(code(1), code(frame)) > max_rest) return false;
  return true;
}

struct Light {
  double r = 0, g = 0, b = 0;
};

Light difference(const Linear& a, const Linear& b) {
  const auto minus = [](float p, float q) { return static_cast<double>(p) - static_cast<double>(q); };
  return {minus(a.r, b.r), minus(a.g, b.g), minus(a.b, b.b)};
}

double product(const Light& a, const Light& b) { return (a.r * b.r + a.g * b.g) + a.b * b.b; }

}  // namespace

std::optional<EventResponse> event_response(Frames reference, Frames test) {
  const int width = reference[0].width(), height = reference[0].height();
  Plane<std::uint8_t> mask(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) mask(x, y) = is_measured(reference[0], x, y) && is_event(reference, x, y) ? 1 : 0;
  });
  const auto sum_over_event = [&](const auto& term) {
    return sum_rows(height, [&](int y) {
      double row = 0;
      for (int x = 0; x < width; ++x) row += mask(x, y) != 0 ? term(x, y) : 0;
      return row;
    });
  };
  const double pixels = sum_over_event([](int, int) { return 1.0; });
  if (pixels < min_share * static_cast<double>(mask.values().size())) return std::nullopt;

  const auto change = [&](int x, int y) { return difference(reference[0].linear(x, y), reference[1].linear(x, y)); };
  const double energy = sum_over_event([&](int x, int y) { return product(change(x, y), change(x, y)); });
  EventResponse out{.remains = {1}, .map = Plane<float>(width, height)};
  for (std::size_t frame = 1; frame < test.size(); ++frame) {
    const LinearImage &expected = reference[frame].linear, &found = test[frame].linear;
    const double kept =
        sum_over_event([&](int x, int y) { return product(difference(found(x, y), expected(x, y)), change(x, y)); });
    out.remains.push_back(kept / energy);
  }
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      if (mask(x, y) == 0) continue;
      const double error = max_difference(reference[1].display(x, y), test[1].display(x, y));
      out.map(x, y) = static_cast<float>(std::min(1.0, error));
    }
  });
  return out;
}

double frames_until(const std::vector<double>& remains, double share) {
  const double target = binary_log(share);
  for (std::size_t k = 1; k < remains.size(); ++k) {
    if (remains[k] > share) continue;
    const auto last = static_cast<double>(k - 1);
    if (remains[k] <= 0) return last;  // the limit of ever faster exponentials
    const double before = binary_log(remains[k - 1]), after = binary_log(remains[k]);
    return last + (before - target) / (before - after);
  }
  const double rate = binary_log(remains.back()) / static_cast<double>(remains.size() - 1);
  return rate < 0 ? target / rate : std::numeric_limits<double>::infinity();
}

}  // namespace zoneplate::metrics
