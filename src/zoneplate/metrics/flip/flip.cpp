// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that a viewer notices when flipping between two images at a stated distance.
//
// Each image is filtered by the contrast sensitivity of the eye at that distance, colours are compared in a
// perceptually uniform space, and edges and points that only one of the images has increase the error.
//
// Weakness: differences below a pixel. At the default 67 pixels per degree, the filter removes most differences between
// antialiasing methods; compare these at 20 to 30 pixels per degree (flip:ppd=25) as well.
#include "zoneplate/metrics/flip/flip.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/flip/color.h"
#include "zoneplate/metrics/flip/filters.h"
#include "zoneplate/metrics/flip/weighted_sums.h"
#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate {
namespace metrics {
namespace {

constexpr int tile_side = 64;

/// The pixels of a tile: [x0, x0 + width) × [y0, y0 + height) of the image.
struct Tile {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

/// The compared quantities of one pixel: the filtered colour, and the strengths of an edge and of a point.
struct Seen {
  Triple color;
  double edge = 0, point = 0;
};

Triple light_of(Linear c) {
  const auto unit = [](float v) { return v > 0 ? static_cast<double>(std::min(v, 1.0f)) : 0.0; };
  return {unit(c.r), unit(c.g), unit(c.b)};
}

/// A tile of one image in YCxCz with a margin of `radius` pixels on all sides, in which the image's border is repeated.
struct Margin {
  Plane<double> y, cx, cz;
};

Margin load_tile(const LinearImage& image, const Tile& tile, int radius) {
  const int width = tile.width + 2 * radius, height = tile.height + 2 * radius;
  Margin out{Plane<double>(width, height), Plane<double>(width, height), Plane<double>(width, height)};
  for (int j = 0; j < height; ++j) {
    const int y = std::clamp(tile.y0 - radius + j, 0, image.height() - 1);
    for (int i = 0; i < width; ++i) {
      const int x = std::clamp(tile.x0 - radius + i, 0, image.width() - 1);
      const Triple c = opponent_from_rgb(light_of(image(x, y)));
      out.y(i, j) = c.x, out.cx(i, j) = c.y, out.cz(i, j) = c.z;
    }
  }
  return out;
}

/// Filters a plane with one set of taps in x and another of the same size in y, and removes its margin.
Plane<double> filter(const Plane<double>& in, int margin, const Taps& across, const Taps& down) {
  const int radius = static_cast<int>(across.size()) / 2;
  const int width = in.width() - 2 * margin, height = in.height() - 2 * margin;
  const auto n = static_cast<std::size_t>(width);
  const FlipKernels& kernels = FlipKernels::of();
  Plane<double> rows(width, height + 2 * radius), out(width, height);
  for (int j = 0; j < rows.height(); ++j)
    kernels.weighted_sums(in.row(j + margin - radius).data() + (margin - radius), 1, across.data(), across.size(),
                          rows.row(j).data(), n);
  for (int j = 0; j < height; ++j)
    kernels.weighted_sums(rows.row(j).data(), n, down.data(), down.size(), out.row(j).data(), n);
  return out;
}

void add(Plane<double>& sum, const Plane<double>& other) {
  for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += other.values()[i];
}

/// Computes the compared quantities of a tile's pixels.
Plane<Seen> look(const LinearImage& image, const Tile& tile, const FlipFilters& f) {
  const int radius = f.radius();
  Margin c = load_tile(image, tile, radius);
  const Plane<double> y = filter(c.y, radius, f.lightness, f.lightness);
  const Plane<double> cx = filter(c.cx, radius, f.red_green, f.red_green);
  Plane<double> cz = filter(c.cz, radius, f.blue_yellow_narrow, f.blue_yellow_narrow);
  add(cz, filter(c.cz, radius, f.blue_yellow_broad, f.blue_yellow_broad));

  // Features are detected in the lightness before the filter, in [0, 1].
  for (double& v : c.y.values()) v = (v + 16) / 116;
  const Plane<double> edge_x = filter(c.y, radius, f.slope, f.smooth), edge_y = filter(c.y, radius, f.smooth, f.slope);
  const Plane<double> point_x = filter(c.y, radius, f.bend, f.smooth), point_y = filter(c.y, radius, f.smooth, f.bend);

  Plane<Seen> seen(tile.width, tile.height);
  for (std::size_t i = 0; i < seen.values().size(); ++i) {
    const Triple rgb = rgb_from_opponent({y.values()[i], cx.values()[i], cz.values()[i]});
    const auto unit = [](double v) { return std::clamp(v, 0.0, 1.0); };
    const auto norm = [i](const Plane<double>& a, const Plane<double>& b) {
      return std::sqrt(a.values()[i] * a.values()[i] + b.values()[i] * b.values()[i]);
    };
    seen.values()[i] = {hunt_lab_from_rgb({unit(rgb.x), unit(rgb.y), unit(rgb.z)}), norm(edge_x, edge_y),
                        norm(point_x, point_y)};
  }
  return seen;
}

/// Maps a colour difference to [0, 1]: differences up to 0.4 of the greatest are mapped to [0, 0.95].
double color_error(Triple a, Triple b, double greatest) {
  constexpr double exponent = 0.7, knee = 0.4, knee_value = 0.95;
  const double d = power(hyab(a, b), exponent);
  const double bend = knee * greatest;
  return d < bend ? d * knee_value / bend : knee_value + (d - bend) / (greatest - bend) * (1 - knee_value);
}

/// Whether the images agree in all pixels that affect a tile.
bool agree_around(const LinearImage& a, const LinearImage& b, const Tile& tile, int radius) {
  const int left = std::max(0, tile.x0 - radius), right = std::min(a.width(), tile.x0 + tile.width + radius);
  const int top = std::max(0, tile.y0 - radius), bottom = std::min(a.height(), tile.y0 + tile.height + radius);
  const auto same = [](const Linear& p, const Linear& q) { return p.r == q.r && p.g == q.g && p.b == q.b; };
  for (int y = top; y < bottom; ++y) {
    const auto part = [&](const LinearImage& image) {
      return image.row(y).subspan(static_cast<std::size_t>(left), static_cast<std::size_t>(right - left));
    };
    if (!std::ranges::equal(part(a), part(b), same)) return false;
  }
  return true;
}

/// The greatest colour difference of the gamut, that between green and blue.
double max_difference() { return power(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), 0.7); }

double error_between(const Seen& a, const Seen& b, double greatest) {
  const double color = color_error(a.color, b.color, greatest);
  const double feature = std::max(std::abs(a.edge - b.edge), std::abs(a.point - b.point));
  return power(color, 1 - std::sqrt(feature / std::sqrt(2.0)));
}

}  // namespace

Plane<float> flip_map(const LinearImage& reference, const LinearImage& test, double pixels_per_degree) {
  const int width = reference.width(), height = reference.height();
  const FlipFilters filters = make_flip_filters(pixels_per_degree);
  const double greatest = max_difference();
  Plane<float> map(width, height);

  // Tiles are for locality in the cache; a pixel's value does not depend on its tile.
  const int across = (width + tile_side - 1) / tile_side, down = (height + tile_side - 1) / tile_side;
  parallel_for(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), [&](std::size_t index) {
    const int x0 = static_cast<int>(index) % across * tile_side, y0 = static_cast<int>(index) / across * tile_side;
    const Tile tile{x0, y0, std::min(tile_side, width - x0), std::min(tile_side, height - y0)};
    if (agree_around(reference, test, tile, filters.radius())) return;  // the error is 0
    const Plane<Seen> a = look(reference, tile, filters), b = look(test, tile, filters);
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        map(x0 + x, y0 + y) = static_cast<float>(std::min(1.0, error_between(a(x, y), b(x, y), greatest)));
      }
    }
  });
  return map;
}

Score score_of_flip(Plane<float> map, const Picture& reference) {
  std::vector<float> sorted;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (is_measured(reference, x, y))
        sorted.push_back(map(x, y));
      else
        map(x, y) = 0;
  const double total = sum_rows(map.height(), [&](int y) {
    double row = 0;
    for (const float value : map.row(y)) row += value;
    return row;
  });
  std::ranges::sort(sorted);
  auto weighted = [&, below = 0.0, at = std::size_t{0}](double share) mutable {
    while (at + 1 < sorted.size() && below + sorted[at] < total * share) below += sorted[at++];
    return static_cast<double>(sorted[at]);
  };
  const double first = weighted(0.25), median = weighted(0.5), third = weighted(0.75);

  Score score;
  score.value = total / static_cast<double>(sorted.size());
  score.more = {{"weighted_first_quartile", first, ""},
                {"weighted_median", median, ""},
                {"weighted_third_quartile", third, ""},
                {"p99", sorted[(sorted.size() - 1) * 99 / 100], ""},
                {"min", sorted.front(), ""},
                {"max", sorted.back(), ""}};
  score.map = std::move(map);
  return score;
}

Metric flip() {
  static constexpr Param params[] = {
      real_param("ppd", "pixels per degree of view", default_pixels_per_degree, 1, 1000)};
  return {.name = "flip",
          .summary = "difference seen when the images alternate, from a stated distance: mean of the map",
          .source = "Andersson et al. 2020",
          .unit = "",
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            return score_of_flip(flip_map(reference[0].linear, test[0].linear, settings.number("ppd")), reference[0]);
          }};
}

}  // namespace metrics
}  // namespace zoneplate
