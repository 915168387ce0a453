// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/window.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

using Values = std::function<double(double)>;

Values make_none(std::span<const double>) {
  return [](double) { return 1.0; };
}

// a0 - a1 cos 2πt + a2 cos 4πt, expressed relative to the middle so that both halves have the same bits.
Values cosines(double a0, double a1, double a2) {
  return [=](double t) {
    const double u = std::abs(2 * t - 1);
    return a0 + a1 * cos_pi(u) + a2 * cos_pi(2 * u);
  };
}
Values make_hann(std::span<const double>) { return cosines(0.5, 0.5, 0); }
Values make_hamming(std::span<const double>) { return cosines(0.54, 0.46, 0); }
Values make_blackman(std::span<const double>) { return cosines(0.42, 0.5, 0.08); }

Values make_kaiser(std::span<const double> p) {
  return [beta = p[0], peak = bessel_i0(p[0])](double t) {
    const double u = 2 * t - 1;
    return bessel_i0(beta * std::sqrt(std::max(0.0, 1 - u * u))) / peak;
  };
}

Values make_tukey(std::span<const double> p) {
  return [alpha = p[0]](double t) {
    const double to_end = std::min(t, 1 - t);
    return to_end >= alpha / 2 ? 1.0 : 0.5 - 0.5 * cos_pi(2 * to_end / alpha);
  };
}

}  // namespace

std::span<const WindowEntry> windows() {
  constexpr std::string_view harris = "Harris, Proc. IEEE 66(1), 1978";
  static const std::vector<WindowEntry> table = {
      {"none", "the ends are cut", harris, {}, make_none},
      {"hann", "a raised cosine; side lobes fall fast", harris, {}, make_hann},
      {"hamming", "a raised cosine on a step; lowest first side lobe", harris, {}, make_hamming},
      {"blackman", "two cosines; side lobes 58 dB down", harris, {}, make_blackman},
      {"kaiser",
       "the most energy in the main lobe, by choice of beta",
       "Kaiser, ISCAS 1974",
       {real_param("beta", "the window's shape: wider and cleaner as it grows", 8.6, 0, 40)},
       make_kaiser},
      {"tukey",
       "flat, with cosine ends",
       harris,
       {real_param("alpha", "share of the length that the ends take", 0.5, 0, 1)},
       make_tukey},
  };
  return table;
}

Window make_window(std::string_view text) {
  const auto spec = parse_spec("window", windows(), text);
  return {spec.text(), spec.row.make(spec.settings.numbers())};
}

std::vector<double> sampled(const Window& window, int n) {
  std::vector<double> out;
  for (int k = 0; k < n; ++k) out.push_back(window.value((k + 0.5) / n));
  return out;
}

double coherent_gain(std::span<const double> samples) {
  double sum = 0;
  for (const double w : samples) sum += w;
  return sum / static_cast<double>(samples.size());
}

double noise_bandwidth(std::span<const double> samples) {
  double sum = 0, squares = 0;
  for (const double w : samples) sum += w, squares += w * w;
  return static_cast<double>(samples.size()) * squares / (sum * sum);
}

Plane<float> windowed(const Plane<float>& plane, const Window& window) {
  const std::vector<double> across = sampled(window, plane.width()), down = sampled(window, plane.height());
  Plane<float> out = plane;
  parallel_for(static_cast<std::size_t>(plane.height()), [&](std::size_t y) {
    const auto row = out.row(static_cast<int>(y));
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = static_cast<float>(static_cast<double>(row[x]) * (across[x] * down[y]));
  });
  return out;
}

}  // namespace zoneplate
