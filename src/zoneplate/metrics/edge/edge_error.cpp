// SPDX-License-Identifier: Apache-2.0
// The error at edges as a function of their angle: staircases and the differences between sample patterns depend on it.
//
// The edges are detected in the reference, so that a method cannot hide an edge by blurring it. Weaknesses: fine
// borders in textures count as edges, and lines thinner than a pixel that are faint in the reference are not detected.
#include "zoneplate/metrics/edge/edge_error.h"

#include <cmath>

#include "zoneplate/math/angle.h"
#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"

namespace zoneplate::metrics {
namespace {

constexpr double min_slope = 0.04, min_ratio = 9;
constexpr int reach = 2;
constexpr double binomial[2 * reach + 1] = {1 / 16.0, 4 / 16.0, 6 / 16.0, 4 / 16.0, 1 / 16.0};

struct Tensor {
  double xx = 0, xy = 0, yy = 0;
};

Plane<Tensor> tensors(const Plane<double>& luma) {
  const int w = luma.width(), h = luma.height();
  Plane<Tensor> own(w, h), rows(w, h), out(w, h);
  for (int y = 1; y + 1 < h; ++y)
    for (int x = 1; x + 1 < w; ++x) {
      const double gx = (luma(x + 1, y) - luma(x - 1, y)) / 2, gy = (luma(x, y + 1) - luma(x, y - 1)) / 2;
      own(x, y) = {gx * gx, gx * gy, gy * gy};
    }
  const auto smooth = [&](const Plane<Tensor>& in, Plane<Tensor>& to, int dx, int dy) {
    for (int y = reach; y + reach < h; ++y)
      for (int x = reach; x + reach < w; ++x) {
        Tensor sum;
        for (int k = -reach; k <= reach; ++k) {
          const Tensor& t = in(x + k * dx, y + k * dy);
          const double weight = binomial[k + reach];
          sum.xx += weight * t.xx, sum.xy += weight * t.xy, sum.yy += weight * t.yy;
        }
        to(x, y) = sum;
      }
  };
  smooth(own, rows, 1, 0);
  smooth(rows, out, 0, 1);
  return out;
}

/// The bin of twice the angle from the nearer axis, which is given as a direction in the first quadrant.
int bin_of(double cosine, double sine) {
  static const std::array<SineCosine, EdgeError::bins> limits = [] {
    std::array<SineCosine, EdgeError::bins> out;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = sine_cosine(1.5707963267948966 * static_cast<double>(i + 1) / EdgeError::bins);
    return out;
  }();
  int bin = 0;
  while (bin + 1 < EdgeError::bins &&
         sine * limits[static_cast<std::size_t>(bin)].cosine >= cosine * limits[static_cast<std::size_t>(bin)].sine)
    ++bin;
  return bin;
}

}  // namespace

std::optional<double> EdgeError::rms(int first, int last) const {
  double squares = 0;
  std::uint64_t pixels = 0;
  for (int i = first; i < last; ++i) {
    squares += by_angle[static_cast<std::size_t>(i)].squares;
    pixels += by_angle[static_cast<std::size_t>(i)].pixels;
  }
  if (pixels == 0) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(pixels));
}

EdgeError measure_edge_error(const Picture& reference, const Picture& test) {
  const Plane<double> truth = luma_plane(reference.display), seen = luma_plane(test.display);
  const Plane<Tensor> around = tensors(truth);
  EdgeError out;
  for (int y = reach; y + reach < truth.height(); ++y)
    for (int x = reach; x + reach < truth.width(); ++x) {
      if (!is_measured(reference, x, y)) continue;
      const double gx = (truth(x + 1, y) - truth(x - 1, y)) / 2, gy = (truth(x, y + 1) - truth(x, y - 1)) / 2;
      if (gx * gx + gy * gy < min_slope * min_slope) continue;
      const Tensor& t = around(x, y);
      const double sum = t.xx + t.yy, difference = t.xx - t.yy, cross = 2 * t.xy;
      const double spread = std::sqrt(difference * difference + cross * cross);
      if (sum + spread < min_ratio * (sum - spread)) continue;
      EdgeError::Bin& bin = out.by_angle[static_cast<std::size_t>(bin_of(std::abs(difference), std::abs(cross)))];
      const double off = seen(x, y) - truth(x, y);
      ++bin.pixels;
      bin.squares += off * off;
    }
  return out;
}

Metric edge_error() {
  return {.name = "edge_error",
          .summary = "root mean square error of luma at the reference's straight edges, and by their angle",
          .source = "structure tensor, Förstner 1987",
          .unit = "code",
          .smallest = 2 * reach + 1,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            const EdgeError error = measure_edge_error(reference[0], test[0]);
            const std::optional<double> all = error.rms();
            if (!all) return std::nullopt;
            Score score{.value = *all};
            const auto figure = [&](const char* name, int first, int last) {
              if (const auto rms = error.rms(first, last)) score.more.push_back({name, *rms, "code"});
            };
            figure("near_axis", 0, 2), figure("oblique", 2, 7), figure("diagonal", 7, EdgeError::bins);
            Curve curve{"error by angle", "angle from the nearer axis (degrees)", "error (code)", {}, {}};
            for (int i = 0; i < EdgeError::bins; ++i)
              if (const auto rms = error.rms(i, i + 1)) curve.x.push_back(5 * i + 2.5), curve.y.push_back(*rms);
            score.curves.push_back(std::move(curve));
            return score;
          }};
}

}  // namespace zoneplate::metrics
