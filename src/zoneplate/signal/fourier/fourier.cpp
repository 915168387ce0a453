// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/fourier.h"

#include <algorithm>
#include <cassert>

#include "zoneplate/base/parallel.h"
#include "zoneplate/signal/fourier/fourier_plan.h"

namespace zoneplate {
namespace {

enum class Direction { Forward, Inverse };

// Four signals side by side, with buffers to transform them. The inverse is the forward transform with the real and
// imaginary parts exchanged, before and after.
struct Work {
  explicit Work(const FourierPlan& p)
      : plan(p), re(p.size() * FourierPlan::lanes), im(p.size() * FourierPlan::lanes), scratch(p.make_scratch()) {}

  void run(Direction direction) {
    direction == Direction::Forward ? plan.forward(re.data(), im.data(), scratch)
                                    : plan.forward(im.data(), re.data(), scratch);
  }
  void put(std::size_t k, std::size_t lane, Complex z) {
    re[k * FourierPlan::lanes + lane] = z.real(), im[k * FourierPlan::lanes + lane] = z.imag();
  }
  Complex at(std::size_t k, std::size_t lane) const {
    return {re[k * FourierPlan::lanes + lane], im[k * FourierPlan::lanes + lane]};
  }

  const FourierPlan& plan;
  std::vector<double> re, im, scratch;
};

std::vector<Complex> transform(std::span<const Complex> in, Direction direction) {
  if (in.empty()) return {};
  const FourierPlan plan(in.size());
  Work work(plan);
  for (std::size_t k = 0; k < in.size(); ++k) work.put(k, 0, in[k]);
  work.run(direction);
  const double scale = direction == Direction::Forward ? 1.0 : 1.0 / static_cast<double>(in.size());
  std::vector<Complex> out(in.size());
  for (std::size_t k = 0; k < in.size(); ++k) out[k] = work.at(k, 0) * scale;
  return out;
}

// Calls body(first, count, work) for blocks of at most `block` of `total` lines, in parallel; several blocks share a
// workspace.
template <class Body>
void for_blocks(std::size_t total, std::size_t block, const FourierPlan& plan, const Body& body) {
  constexpr std::size_t blocks_per_task = 4;
  parallel_ranges(total, block * blocks_per_task, [&](std::size_t begin, std::size_t end) {
    Work work(plan);
    for (std::size_t first = begin; first < end; first += block) body(first, std::min(block, end - first), work);
  });
}

int as_int(std::size_t i) { return static_cast<int>(i); }

void transform_rows(Plane<Complex>& plane, Direction direction) {
  const auto w = static_cast<std::size_t>(plane.width());
  const FourierPlan plan(w);
  for_blocks(static_cast<std::size_t>(plane.height()), FourierPlan::lanes, plan,
             [&](std::size_t y, std::size_t count, Work& work) {
               for (std::size_t l = 0; l < count; ++l) {
                 const auto row = plane.row(as_int(y + l));
                 for (std::size_t k = 0; k < w; ++k) work.put(k, l, row[k]);
               }
               work.run(direction);
               for (std::size_t l = 0; l < count; ++l) {
                 const auto row = plane.row(as_int(y + l));
                 for (std::size_t k = 0; k < w; ++k) row[k] = work.at(k, l);
               }
             });
}

void transform_columns(Plane<Complex>& plane, Direction direction) {
  const auto h = static_cast<std::size_t>(plane.height());
  const FourierPlan plan(h);
  for_blocks(static_cast<std::size_t>(plane.width()), FourierPlan::lanes, plan,
             [&](std::size_t x, std::size_t count, Work& work) {
               for (std::size_t k = 0; k < h; ++k) {
                 const auto part = plane.row(as_int(k)).subspan(x, count);
                 for (std::size_t l = 0; l < count; ++l) work.put(k, l, part[l]);
               }
               work.run(direction);
               for (std::size_t k = 0; k < h; ++k) {
                 const auto part = plane.row(as_int(k)).subspan(x, count);
                 for (std::size_t l = 0; l < count; ++l) part[l] = work.at(k, l);
               }
             });
}

// Two real rows are transformed as the real and imaginary part of one complex row: Z = A + iB, where A and B are the
// parts of Z that have the symmetry of real signals' spectra.
template <class T>
Spectrum real_forward(const Plane<T>& plane) {
  Spectrum out{plane.width(), Plane<Complex>(plane.empty() ? 0 : plane.width() / 2 + 1, plane.height())};
  if (plane.empty()) return out;
  const auto w = static_cast<std::size_t>(plane.width()), h = static_cast<std::size_t>(plane.height());
  const FourierPlan plan(w);
  for_blocks(h, 2 * FourierPlan::lanes, plan, [&](std::size_t y, std::size_t count, Work& work) {
    for (std::size_t r = 0; r < 2 * FourierPlan::lanes; ++r) {
      auto& part = r % 2 == 0 ? work.re : work.im;
      if (r >= count) {
        for (std::size_t x = 0; x < w; ++x) part[x * FourierPlan::lanes + r / 2] = 0;
        continue;
      }
      const auto row = plane.row(as_int(y + r));
      for (std::size_t x = 0; x < w; ++x) part[x * FourierPlan::lanes + r / 2] = static_cast<double>(row[x]);
    }
    work.run(Direction::Forward);
    for (std::size_t r = 0; r < count; ++r) {
      const auto row = out.half.row(as_int(y + r));
      for (std::size_t k = 0; k <= w / 2; ++k) {
        const Complex z = work.at(k, r / 2), m = work.at(k == 0 ? 0 : w - k, r / 2);
        row[k] = r % 2 == 0 ? Complex{(z.real() + m.real()) / 2, (z.imag() - m.imag()) / 2}
                            : Complex{(z.imag() + m.imag()) / 2, (m.real() - z.real()) / 2};
      }
    }
  });
  transform_columns(out.half, Direction::Forward);
  return out;
}

// Bin k of a real signal, given its bins 0 to n / 2.
Complex real_bin(std::span<const Complex> half, std::size_t k, std::size_t n) {
  if (k == 0 || 2 * k == n) return {half[k].real(), 0};
  return 2 * k < n ? half[k] : std::conj(half[n - k]);
}

template <class T>
Plane<T> real_inverse(const Spectrum& spectrum) {
  Plane<T> out(spectrum.width, spectrum.height());
  if (out.empty()) return out;
  Plane<Complex> half = spectrum.half;
  transform_columns(half, Direction::Inverse);
  const auto w = static_cast<std::size_t>(out.width()), h = static_cast<std::size_t>(out.height());
  const double scale = 1.0 / (static_cast<double>(w) * static_cast<double>(h));
  const FourierPlan plan(w);
  for_blocks(h, 2 * FourierPlan::lanes, plan, [&](std::size_t y, std::size_t count, Work& work) {
    for (std::size_t r = 0; r < count; r += 2) {
      const auto a = half.row(as_int(y + r));
      for (std::size_t k = 0; k < w; ++k) {
        const Complex za = real_bin(a, k, w);
        const Complex zb = r + 1 < count ? real_bin(half.row(as_int(y + r + 1)), k, w) : Complex{};
        work.put(k, r / 2, {za.real() - zb.imag(), za.imag() + zb.real()});
      }
    }
    work.run(Direction::Inverse);
    for (std::size_t r = 0; r < count; ++r) {
      const auto row = out.row(as_int(y + r));
      const auto& part = r % 2 == 0 ? work.re : work.im;
      for (std::size_t x = 0; x < w; ++x) row[x] = static_cast<T>(part[x * FourierPlan::lanes + r / 2] * scale);
    }
  });
  return out;
}

}  // namespace

std::vector<Complex> fourier(std::span<const Complex> signal) { return transform(signal, Direction::Forward); }
std::vector<Complex> inverse_fourier(std::span<const Complex> spectrum) {
  return transform(spectrum, Direction::Inverse);
}

std::vector<Complex> fourier(std::span<const double> signal) {
  if (signal.empty()) return {};
  std::vector<Complex> full = fourier(std::vector<Complex>(signal.begin(), signal.end()));
  full.resize(signal.size() / 2 + 1);
  return full;
}

std::vector<double> inverse_fourier(std::span<const Complex> half_spectrum, int size) {
  if (size == 0) return {};
  const auto n = static_cast<std::size_t>(size);
  assert(half_spectrum.size() == n / 2 + 1);
  std::vector<Complex> full(n);
  for (std::size_t k = 0; k < n; ++k) full[k] = real_bin(half_spectrum, k, n);
  full = inverse_fourier(full);
  std::vector<double> out(n);
  for (std::size_t k = 0; k < n; ++k) out[k] = full[k].real();
  return out;
}

Plane<Complex> fourier(const Plane<Complex>& plane) {
  Plane<Complex> out = plane;
  if (out.empty()) return out;
  transform_rows(out, Direction::Forward);
  transform_columns(out, Direction::Forward);
  return out;
}

Plane<Complex> inverse_fourier(const Plane<Complex>& spectrum) {
  Plane<Complex> out = spectrum;
  if (out.empty()) return out;
  transform_columns(out, Direction::Inverse);
  transform_rows(out, Direction::Inverse);
  const double scale = 1.0 / (static_cast<double>(out.width()) * static_cast<double>(out.height()));
  for (Complex& z : out.values()) z *= scale;
  return out;
}

Complex Spectrum::at(int kx, int ky) const {
  const auto wrap = [](int k, int n) { return ((k % n) + n) % n; };
  const int x = wrap(kx, width), y = wrap(ky, height());
  return 2 * x <= width ? half(x, y) : std::conj(half(width - x, wrap(-y, height())));
}

Spectrum fourier(const Plane<float>& plane) { return real_forward(plane); }
Spectrum fourier(const Plane<double>& plane) { return real_forward(plane); }

Plane<float> inverse_fourier(const Spectrum& spectrum) { return real_inverse<float>(spectrum); }
Plane<double> inverse_fourier_double(const Spectrum& spectrum) { return real_inverse<double>(spectrum); }

}  // namespace zoneplate
