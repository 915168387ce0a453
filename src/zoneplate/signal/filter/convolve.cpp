// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/convolve.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/channels.h"
#include "zoneplate/signal/filter/row_sum.h"
#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/fourier/fourier_plan.h"

namespace zoneplate {
namespace {

// The reach of a kernel on each side: the taps after the origin reach to the left and top.
Margins margins_of(const Plane<float>& kernel) {
  const int w = kernel.width(), h = kernel.height();
  return {.left = w - 1 - w / 2, .top = h - 1 - h / 2, .right = w / 2, .bottom = h / 2};
}

template <class T>
Plane<T> direct(const Plane<T>& plane, const Plane<float>& kernel, const ConvolveOptions& options) {
  assert(!kernel.empty());
  if (plane.empty()) return plane;
  const std::vector<double> weights(kernel.values().begin(), kernel.values().end());
  const Plane<T> wide = padded(plane, margins_of(kernel), options.border);
  Plane<T> out(plane.width(), plane.height());
  parallel_for(static_cast<std::size_t>(plane.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::vector<const float*> rows;
    for (int j = kernel.height() - 1; j >= 0; --j)
      for (int i = kernel.width() - 1; i >= 0; --i)
        rows.push_back(floats(std::as_const(wide).row(y + j).subspan(static_cast<std::size_t>(i))));
    RowSumKernels::of().wide(rows.data(), 0, weights.data(), weights.size(), floats(out.row(y)),
                             static_cast<std::size_t>(plane.width()) * channels<T>);
  });
  return out;
}

// The spectrum of the kernel on a periodic plane of this size, with the kernel's origin at (0, 0). The kernel may be
// larger than the plane.
Spectrum spectrum_of_kernel(const Plane<float>& kernel, int width, int height) {
  Plane<double> folded(width, height);
  for (int j = 0; j < kernel.height(); ++j)
    for (int i = 0; i < kernel.width(); ++i) {
      const int x = border_index(i - kernel.width() / 2, width, Border::Wrap);
      const int y = border_index(j - kernel.height() / 2, height, Border::Wrap);
      folded(x, y) += static_cast<double>(kernel(i, j));
    }
  return fourier(folded);
}

void multiply(Spectrum& a, const Spectrum& b) {
  for (std::size_t i = 0; i < a.half.values().size(); ++i) {
    const Complex u = a.half.values()[i], v = b.half.values()[i];
    a.half.values()[i] = {u.real() * v.real() - u.imag() * v.imag(), u.real() * v.imag() + u.imag() * v.real()};
  }
}

// The plane extended by its border, and by further pixels to a size with a fast transform; those do not affect the
// result.
Plane<float> surrounded(const Plane<float>& plane, const Margins& margins, Border border) {
  const Plane<float> wide = padded(plane, margins, border);
  const auto room = [](int n) { return static_cast<int>(fast_size(static_cast<std::size_t>(n))) - n; };
  return padded(wide, {.right = room(wide.width()), .bottom = room(wide.height())}, Border::Zero);
}

}  // namespace

Plane<float> convolve(const Plane<float>& plane, const Plane<float>& kernel, const ConvolveOptions& options) {
  return direct(plane, kernel, options);
}
LinearImage convolve(const LinearImage& image, const Plane<float>& kernel, const ConvolveOptions& options) {
  return direct(image, kernel, options);
}

Plane<float> convolve_by_fourier(const Plane<float>& plane, const Plane<float>& kernel, Border border) {
  assert(!kernel.empty());
  if (plane.empty()) return plane;
  const Margins margins = border == Border::Wrap ? Margins{} : margins_of(kernel);
  const Plane<float> wide = border == Border::Wrap ? plane : surrounded(plane, margins, border);
  Spectrum spectrum = fourier(wide);
  multiply(spectrum, spectrum_of_kernel(kernel, wide.width(), wide.height()));
  return cropped(inverse_fourier(spectrum), margins.left, margins.top, plane.width(), plane.height());
}

LinearImage convolve_by_fourier(const LinearImage& image, const Plane<float>& kernel, Border border) {
  LinearImage out(image.width(), image.height());
  for (float Linear::*channel : {&Linear::r, &Linear::g, &Linear::b, &Linear::a}) {
    Plane<float> plane(image.width(), image.height());
    for (std::size_t i = 0; i < plane.values().size(); ++i) plane.values()[i] = image.values()[i].*channel;
    plane = convolve_by_fourier(plane, kernel, border);
    for (std::size_t i = 0; i < plane.values().size(); ++i) out.values()[i].*channel = plane.values()[i];
  }
  return out;
}

Plane<float> outer_product(std::span<const double> along_rows, std::span<const double> along_columns) {
  Plane<float> out(static_cast<int>(along_rows.size()), static_cast<int>(along_columns.size()));
  for (std::size_t y = 0; y < along_columns.size(); ++y)
    for (std::size_t x = 0; x < along_rows.size(); ++x)
      out(static_cast<int>(x), static_cast<int>(y)) = static_cast<float>(along_columns[y] * along_rows[x]);
  return out;
}

}  // namespace zoneplate
