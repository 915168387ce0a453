// SPDX-License-Identifier: Apache-2.0
// Structural similarity of luma: the correlation of the images' local structure, independently of their level.
//
// Weaknesses: small contrasts and small windows: it tolerates blur where the image is smooth, and a shift of a fine
// texture by one pixel costs as much as its loss.
#include "zoneplate/metrics/ssim/ssim.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <vector>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

constexpr int max_side = 11;  // 3.5 sigma of 1.5 on both sides, rounded
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
constexpr int block_rows = 32;

/// The two means, mean squares and mean product of a window.
struct Moments {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
};

Moments operator*(double w, const Moments& m) { return {w * m.a, w * m.b, w * m.aa, w * m.bb, w * m.ab}; }
Moments& operator+=(Moments& sum, const Moments& m) {
  sum.a += m.a, sum.b += m.b, sum.aa += m.aa, sum.bb += m.bb, sum.ab += m.ab;
  return sum;
}

/// A separable window: one row of weights, and its reach before and behind its pixel.
struct Window {
  std::vector<double> weights;
  int before = 0, behind = 0;
  double unbias = 1;  ///< factor of variances and covariance
};

Window make_window(const SimilarityWindow& choice) {
  const int side = choice.side == 0 ? max_side : choice.side;
  assert(side >= 2 && side <= max_side);
  Window window{.weights = std::vector<double>(static_cast<std::size_t>(side), 1.0),
                .before = (side - 1) / 2,
                .behind = side / 2};
  if (choice.side == 0)
    for (int i = 0; i < side; ++i) {
      const int away = i - window.before;
      window.weights[static_cast<std::size_t>(i)] = natural_exp(-away * away / (2 * 1.5 * 1.5));
    }
  double sum = 0;
  for (const double w : window.weights) sum += w;
  for (double& w : window.weights) w /= sum;
  if (choice.is_unbiased) window.unbias = static_cast<double>(side * side) / (side * side - 1);
  return window;
}

/// The index mirrored into [0, n) about the border, the edge pixel repeated. Requires -n <= i < 2n.
int mirrored(int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; }

/// One row of moments, after the horizontal pass of the window.
void filter_row(std::span<const double> a, std::span<const double> b, const Window& window, std::span<Moments> out) {
  const int width = static_cast<int>(a.size());
  for (int x = 0; x < width; ++x) {
    Moments sum;
    for (int i = -window.before; i <= window.behind; ++i) {
      const auto at = static_cast<std::size_t>(mirrored(x + i, width));
      sum += window.weights[static_cast<std::size_t>(i + window.before)] *
             Moments{a[at], b[at], a[at] * a[at], b[at] * b[at], a[at] * b[at]};
    }
    out[static_cast<std::size_t>(x)] = sum;
  }
}

/// SSIM and its contrast-structure factor, of one window or summed over `count` windows.
struct Terms {
  double ssim = 0, contrast = 0, count = 1;
};

Terms terms_of(const Moments& m, double unbias) {
  const double product = m.a * m.b, squares = m.a * m.a + m.b * m.b;
  const double covariance = (m.ab - product) * unbias;
  const double variances = ((m.aa - m.a * m.a) + (m.bb - m.b * m.b)) * unbias;
  const double contrast = (2 * covariance + c2) / (variances + c2);
  return {(2 * product + c1) / (squares + c1) * contrast, contrast};
}

/// Computes rows [begin, end) of the map, and each row's sums over the windows that are inside the image.
void measure_rows(const Plane<double>& a, const Plane<double>& b, int begin, int end, const Window& window,
                  const Plane<std::uint8_t>& is_ignored, Plane<float>& map, std::span<Terms> row_sums) {
  const int width = a.width(), height = a.height();
  const int reach = window.before + window.behind;
  Plane<Moments> rows(width, end - begin + reach);
  for (int i = 0; i < rows.height(); ++i) {
    const int y = mirrored(begin - window.before + i, height);
    filter_row(a.row(y), b.row(y), window, rows.row(i));
  }
  for (int y = begin; y < end; ++y) {
    for (int x = 0; x < width; ++x) {
      Moments sum;
      for (int i = 0; i <= reach; ++i) sum += window.weights[static_cast<std::size_t>(i)] * rows(x, y - begin + i);
      const Terms terms = terms_of(sum, window.unbias);
      const bool is_measured = is_ignored.empty() || is_ignored(x, y) == 0;
      map(x, y) = is_measured ? static_cast<float>(terms.ssim) : 1.0f;
      if (!is_measured || x < window.before || x >= width - window.behind) continue;
      Terms& row = row_sums[static_cast<std::size_t>(y)];
      row.ssim += terms.ssim, row.contrast += terms.contrast, row.count += 1;
    }
  }
}

}  // namespace

Similarity structural_similarity(const Plane<double>& reference, const Plane<double>& test, SimilarityWindow choice,
                                 const Plane<std::uint8_t>& is_ignored) {
  const int width = reference.width(), height = reference.height();
  assert(width >= max_side && height >= max_side && test.width() == width && test.height() == height);
  const Window window = make_window(choice);
  Similarity out;
  out.map = Plane<float>(width, height);
  std::vector<Terms> row_sums(static_cast<std::size_t>(height), Terms{.count = 0});
  parallel_ranges(static_cast<std::size_t>(height), block_rows, [&](std::size_t begin, std::size_t end) {
    measure_rows(reference, test, static_cast<int>(begin), static_cast<int>(end), window, is_ignored, out.map,
                 row_sums);
  });

  Terms sum{.count = 0};
  for (int y = window.before; y < height - window.behind; ++y) {
    sum.ssim += row_sums[static_cast<std::size_t>(y)].ssim;
    sum.contrast += row_sums[static_cast<std::size_t>(y)].contrast;
    sum.count += row_sums[static_cast<std::size_t>(y)].count;
  }
  out.ssim = sum.ssim / sum.count;
  out.contrast = sum.contrast / sum.count;
  return out;
}

namespace {

/// SSIM of a grey image, or the mean of SSIM over red, green and blue, with the value and the map.
std::optional<Score> similarity_score(const Picture& reference, const Picture& test, const Settings& settings) {
  static constexpr LumaWeights channels[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const SimilarityWindow window{static_cast<int>(settings.number("window")), settings.number("unbiased") != 0};
  const auto of = [&](LumaWeights w) {
    return structural_similarity(luma_plane(reference.display, w), luma_plane(test.display, w), window,
                                 reference.is_ignored);
  };
  Similarity s = of(settings.number("rgb") != 0 ? channels[0] : rec709_luma);
  if (settings.number("rgb") != 0) {
    for (const LumaWeights w : {channels[1], channels[2]}) {
      const Similarity other = of(w);
      s.ssim += other.ssim;
      std::ranges::transform(s.map.values(), other.map.values(), s.map.values().begin(), std::plus<>());
    }
    s.ssim /= 3;
    for (float& value : s.map.values()) value /= 3;
  }
  if (std::isnan(s.ssim)) return std::nullopt;
  for (float& value : s.map.values()) value = (1 - value) / 2;
  return Score{.value = s.ssim, .map = std::move(s.map)};
}

}  // namespace

Metric ssim() {
  static constexpr int sides[] = {0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, flags[] = {0, 1};
  static constexpr Param params[] = {
      {.name = "window", .meaning = "side of a uniform window; 0: Gaussian of sigma 1.5, 11 pixels", .choices = sides},
      {.name = "unbiased", .meaning = "1: variances divided by n - 1", .choices = flags},
      {.name = "rgb", .meaning = "1: the mean of red, green and blue in place of luma", .choices = flags}};
  return {.name = "ssim",
          .summary = "structural similarity of Rec.709 luma of sRGB codes, Gaussian window of sigma 1.5",
          .source = "Wang, Bovik, Sheikh, Simoncelli 2004",
          .unit = "",
          .better = Better::Higher,
          .perfect = 1.0,
          .smallest = max_side,
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            return similarity_score(reference[0], test[0], settings);
          }};
}

}  // namespace zoneplate::metrics
