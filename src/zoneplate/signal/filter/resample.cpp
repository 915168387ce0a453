// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/resample.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/channels.h"
#include "zoneplate/signal/filter/row_sum.h"
#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

struct Axis {
  int size = 0;  // pixels of the output
  double step = 1, shift = 0;
  int first = 0;  // index of the first pixel in the whole output
};

double centre_of(int i, const Axis& axis) { return axis.shift + (axis.first + i + 0.5) * axis.step - 0.5; }

template <class T>
Plane<T> transposed(const Plane<T>& plane) {
  constexpr int tile = 16;
  Plane<T> out(plane.height(), plane.width());
  parallel_ranges(static_cast<std::size_t>(plane.width()), tile, [&](std::size_t begin, std::size_t end) {
    for (int y0 = 0; y0 < plane.height(); y0 += tile)
      for (int x = static_cast<int>(begin); x < static_cast<int>(end); ++x)
        for (int y = y0; y < std::min(plane.height(), y0 + tile); ++y) out(y, x) = plane(x, y);
  });
  return out;
}

// Removes the weights outside [0, size) and divides the others by their sum. The centre is within half a step of the
// pixels. If a kernel with negative lobes leaves no positive sum, the nearest pixel gets weight 1.
void cut_weights(PixelWeights& w, int size) {
  const int nearest = std::clamp(w.first + static_cast<int>(w.weights.size()) / 2, 0, size - 1);
  const int before = std::max(0, -w.first), count = static_cast<int>(w.weights.size());
  const int behind = std::max(0, w.first + count - size);
  if (before == 0 && behind == 0) return;
  if (before + behind < count) {
    w.weights.erase(w.weights.end() - behind, w.weights.end());
    w.weights.erase(w.weights.begin(), w.weights.begin() + before);
    w.first += before;
    double sum = 0;
    for (const double weight : w.weights) sum += weight;
    for (double& weight : w.weights) weight /= sum;
    if (sum > 0) return;
  }
  w = {nearest, {1}};
}

// Resamples along columns: each output row is a weighted sum of input rows.
template <class T>
Plane<T> along_columns(const Plane<T>& plane, const Axis& axis, const Kernel& kernel, const ResampleOptions& options) {
  const RowSumKernels& kernels = RowSumKernels::of();
  const std::size_t width = static_cast<std::size_t>(plane.width()) * channels<T>;
  const std::vector<float> zeros(width);
  Plane<T> out(plane.width(), axis.size);
  constexpr std::size_t rows_at_once = 8;
  parallel_ranges(static_cast<std::size_t>(axis.size), rows_at_once, [&](std::size_t begin, std::size_t end) {
    std::vector<const float*> rows;
    for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
      PixelWeights w = pixel_weights(kernel, centre_of(i, axis), std::max(1.0, axis.step));
      if (options.border == Border::Cut) cut_weights(w, plane.height());
      rows.clear();
      for (std::size_t t = 0; t < w.weights.size(); ++t) {
        const int y = border_index(w.first + static_cast<int>(t), plane.height(), options.border);
        rows.push_back(y < 0 ? zeros.data() : floats(plane.row(y)));
      }
      kernels.wide(rows.data(), 0, w.weights.data(), w.weights.size(), floats(out.row(i)), width);
    }
  });
  return out;
}

template <class T>
Plane<T> resample_any(const Plane<T>& plane, int width, int height, const Kernel& kernel,
                      const ResampleOptions& options) {
  if (plane.empty() || width == 0 || height == 0) return Plane<T>(width, height, T{});
  const auto step = [](double given, int in, int out) { return given > 0 ? given : double{1} * in / out; };
  const Axis x = {width, step(options.step_x, plane.width(), width), options.shift_x, options.first_x};
  const Axis y = {height, step(options.step_y, plane.height(), height), options.shift_y, options.first_y};
  return transposed(along_columns(transposed(along_columns(plane, y, kernel, options)), x, kernel, options));
}

template <class T>
Plane<T> nearest(const Plane<T>& plane, int width, int height) {
  Plane<T> out(width, height);
  if (plane.empty()) return out;
  const auto source = [](int i, int in, int size) {
    return static_cast<int>((2 * std::int64_t{i} + 1) * in / (2 * std::int64_t{size}));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out(x, y) = plane(source(x, plane.width(), width), source(y, plane.height(), height));
  return out;
}

// Resamples a spectrum along one direction from `in` to `out` pixels: `take(k)` is bin k. Bin k is rotated by the
// position of the first pixel's centre, (step - 1) / 2.
template <class Take, class Put>
void move_bins(int in, int out, const Take& take, const Put& put) {
  const int common = std::min(in, out);
  for (int k = -((common - 1) / 2); 2 * k < common; ++k) {
    // e^(2πi k (in/out - 1) / (2 in)) = e^(πi k (in - out) / (in out))
    const SineCosine turn = sin_cos_pi(static_cast<double>(k) * (in - out) / (static_cast<double>(in) * out));
    put(k < 0 ? k + out : k, take(k < 0 ? k + in : k) * Complex{turn.cosine, turn.sine});
  }
  if (in == out && in % 2 == 0) put(in / 2, take(in / 2));
}

}  // namespace

PixelWeights pixel_weights(const Kernel& kernel, double centre, double stretch) {
  // A pixel within rounding error of the kernel's end counts as at its end, where a discontinuous kernel has the mean
  // of both sides. Otherwise rounding would select one side, and not consistently on the left and on the right.
  constexpr double rounding = 1e-9;
  const double reach = kernel.radius * stretch;
  PixelWeights out{static_cast<int>(std::ceil(centre - reach - rounding)), {}};
  double sum = 0;
  for (int j = out.first; j <= static_cast<int>(std::floor(centre + reach + rounding)); ++j) {
    const double away = std::abs(j - centre);
    out.weights.push_back(kernel.value(std::abs(away - reach) <= rounding ? kernel.radius : away / stretch));
    sum += out.weights.back();
  }
  // A kernel narrower than a pixel may contain no pixel centre: then the nearest pixel gets weight 1.
  if (!(sum > 0)) return {static_cast<int>(std::floor(centre + 0.5)), {1}};
  for (double& w : out.weights) w /= sum;
  return out;
}

double place_error(const Kernel& kernel, double step) {
  constexpr int phases = 256;
  double worst = 0;
  for (int p = 0; p < phases; ++p) {
    const double centre = static_cast<double>(p) / phases;
    const PixelWeights w = pixel_weights(kernel, centre, std::max(1.0, step));
    double place = 0;
    for (std::size_t t = 0; t < w.weights.size(); ++t) place += w.weights[t] * (w.first + static_cast<int>(t) - centre);
    worst = std::max(worst, std::abs(place) / step);
  }
  return worst;
}

Plane<float> resample(const Plane<float>& plane, int width, int height, const Kernel& kernel,
                      const ResampleOptions& options) {
  return resample_any(plane, width, height, kernel, options);
}
LinearImage resample(const LinearImage& image, int width, int height, const Kernel& kernel,
                     const ResampleOptions& options) {
  return resample_any(image, width, height, kernel, options);
}

Plane<float> resample_nearest(const Plane<float>& plane, int width, int height) {
  return nearest(plane, width, height);
}
LinearImage resample_nearest(const LinearImage& image, int width, int height) { return nearest(image, width, height); }

Plane<float> resample_ideal(const Plane<float>& plane, int width, int height) {
  Plane<float> out(width, height);
  if (plane.empty() || out.empty()) return out;
  const Spectrum spectrum = fourier(plane);
  Plane<Complex> columns(width, plane.height());
  for (int y = 0; y < plane.height(); ++y)
    move_bins(
        plane.width(), width, [&](int k) { return spectrum.at(k, y); }, [&](int k, Complex z) { columns(k, y) = z; });
  Plane<Complex> both(width, height);
  for (int x = 0; x < width; ++x)
    move_bins(
        plane.height(), height, [&](int k) { return columns(x, k); }, [&](int k, Complex z) { both(x, k) = z; });
  both = inverse_fourier(both);
  // The inverse transform divides by the size of the output, but the forward transform did not divide by that of the
  // input.
  const double scale = static_cast<double>(width) * height / (static_cast<double>(plane.width()) * plane.height());
  for (std::size_t i = 0; i < out.values().size(); ++i)
    out.values()[i] = static_cast<float>(both.values()[i].real() * scale);
  return out;
}

}  // namespace zoneplate
