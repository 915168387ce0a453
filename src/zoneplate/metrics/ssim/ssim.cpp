// Structural similarity of luma: do the two pictures rise and fall together, whatever their level?
//
// Weak on small contrasts and on tiny windows: it forgives blur where the picture is smooth, and a shift of one pixel
// in a fine texture costs as much as its loss.
#include "zoneplate/metrics/ssim/ssim.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

constexpr int radius = 5;  // 3.5 sigma of 1.5, rounded
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
constexpr int block_rows = 32;

/// The two means, mean squares and mean product under the window.
struct Moments {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
};

Moments operator*(double w, const Moments& m) { return {w * m.a, w * m.b, w * m.aa, w * m.bb, w * m.ab}; }
Moments& operator+=(Moments& sum, const Moments& m) {
  sum.a += m.a, sum.b += m.b, sum.aa += m.aa, sum.bb += m.bb, sum.ab += m.ab;
  return sum;
}

using Window = std::array<double, 2 * radius + 1>;

Window gaussian_window() {
  Window window{};
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    window[static_cast<std::size_t>(i + radius)] = natural_exp(-i * i / (2 * 1.5 * 1.5));
    sum += window[static_cast<std::size_t>(i + radius)];
  }
  for (double& w : window) w /= sum;
  return window;
}

/// The index mirrored into [0, n) about the border, the edge pixel twice. Requires -n <= i < 2n.
int mirrored(int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; }

/// One row of moments under the window's horizontal factor.
void filter_row(std::span<const double> a, std::span<const double> b, const Window& window, std::span<Moments> out) {
  const int width = static_cast<int>(a.size());
  for (int x = 0; x < width; ++x) {
    Moments sum;
    for (int i = -radius; i <= radius; ++i) {
      const auto at = static_cast<std::size_t>(mirrored(x + i, width));
      sum += window[static_cast<std::size_t>(i + radius)] *
             Moments{a[at], b[at], a[at] * a[at], b[at] * b[at], a[at] * b[at]};
    }
    out[static_cast<std::size_t>(x)] = sum;
  }
}

/// SSIM and its contrast-structure factor from the moments of one window.
struct Terms {
  double ssim = 0, contrast = 0;
};

Terms terms_of(const Moments& m) {
  const double product = m.a * m.b, squares = m.a * m.a + m.b * m.b;
  const double covariance = m.ab - product;
  const double variances = (m.aa - m.a * m.a) + (m.bb - m.b * m.b);
  const double contrast = (2 * covariance + c2) / (variances + c2);
  return {(2 * product + c1) / (squares + c1) * contrast, contrast};
}

/// Rows [begin, end) of the map, and each row's sums over the columns whose windows lie inside.
void measure_rows(const Plane<double>& a, const Plane<double>& b, int begin, int end, const Window& window,
                  Plane<float>& map, std::span<Terms> row_sums) {
  const int width = a.width(), height = a.height();
  Plane<Moments> rows(width, end - begin + 2 * radius);
  for (int i = 0; i < rows.height(); ++i) {
    const int y = mirrored(begin - radius + i, height);
    filter_row(a.row(y), b.row(y), window, rows.row(i));
  }
  for (int y = begin; y < end; ++y) {
    for (int x = 0; x < width; ++x) {
      Moments sum;
      for (int i = 0; i <= 2 * radius; ++i) sum += window[static_cast<std::size_t>(i)] * rows(x, y - begin + i);
      const Terms terms = terms_of(sum);
      map(x, y) = static_cast<float>(terms.ssim);
      if (x < radius || x >= width - radius) continue;
      row_sums[static_cast<std::size_t>(y)].ssim += terms.ssim;
      row_sums[static_cast<std::size_t>(y)].contrast += terms.contrast;
    }
  }
}

}  // namespace

Similarity structural_similarity(const Plane<double>& reference, const Plane<double>& test) {
  const int width = reference.width(), height = reference.height();
  assert(width > 2 * radius && height > 2 * radius && test.width() == width && test.height() == height);
  const Window window = gaussian_window();
  Similarity out;
  out.map = Plane<float>(width, height);
  std::vector<Terms> row_sums(static_cast<std::size_t>(height));
  parallel_ranges(static_cast<std::size_t>(height), block_rows, [&](std::size_t begin, std::size_t end) {
    measure_rows(reference, test, static_cast<int>(begin), static_cast<int>(end), window, out.map, row_sums);
  });

  Terms sum;
  for (int y = radius; y < height - radius; ++y) {
    sum.ssim += row_sums[static_cast<std::size_t>(y)].ssim;
    sum.contrast += row_sums[static_cast<std::size_t>(y)].contrast;
  }
  const double count = static_cast<double>(width - 2 * radius) * (height - 2 * radius);
  out.ssim = sum.ssim / count;
  out.contrast = sum.contrast / count;
  return out;
}

Metric ssim() {
  return {.name = "ssim",
          .summary = "structural similarity of Rec.709 luma of sRGB codes, Gaussian window of sigma 1.5",
          .source = "Wang, Bovik, Sheikh, Simoncelli 2004",
          .unit = "",
          .better = Better::Higher,
          .perfect = 1.0,
          .smallest = 2 * radius + 1,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            Similarity s = structural_similarity(luma_plane(reference[0].display), luma_plane(test[0].display));
            for (float& value : s.map.values()) value = (1 - value) / 2;
            return Score{.value = s.ssim, .map = std::move(s.map)};
          }};
}

}  // namespace zoneplate::metrics
