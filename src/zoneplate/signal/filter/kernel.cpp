// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/kernel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

using std::numbers::pi;

// ∫ f over [a, b] by 8-point Gauss-Legendre quadrature on equal panels, summed in order.
template <class F>
double integrate(const F& f, double a, double b, int panels) {
  static constexpr double node[] = {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                                    0.96028985649753623168};
  static constexpr double weight[] = {0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                                      0.10122853629037625915};
  const double half = (b - a) / (2 * panels);
  double sum = 0;
  for (int p = 0; p < panels; ++p) {
    const double middle = a + (2 * p + 1) * half;
    for (int i = 0; i < 4; ++i) sum += weight[i] * (f(middle - half * node[i]) + f(middle + half * node[i]));
  }
  return sum * half;
}

// The number of panels that suffices for a kernel whose features are `feature` samples long, times a cosine of
// frequency f.
int panels_for(double length, double feature, double f) {
  return static_cast<int>(std::min(1e6, std::ceil(length * std::max(4 / feature, 4 * std::abs(f))))) + 1;
}

// The even function with these values inside its radius; at the radius itself, the mean of both sides.
template <class F>
std::function<double(double)> even(double radius, const F& inside) {
  return [=](double x) {
    const double a = std::abs(x);
    return a < radius ? inside(a) : a == radius ? inside(a) / 2 : 0.0;
  };
}

// The integral from -∞ to x, given that from 0 to a for a in [0, radius].
template <class F>
std::function<double(double)> integral_from(double radius, const F& half) {
  return [=, whole = half(radius)](double x) {
    const double part = half(std::min(std::abs(x), radius));
    return x < 0 ? whole - part : whole + part;
  };
}

// A kernel whose integral and response are computed by quadrature, for lack of a simple closed form.
template <class F>
Kernel by_quadrature(double radius, double feature, const F& inside) {
  const auto half = [=](double a) { return a > 0 ? integrate(inside, 0, a, panels_for(a, feature, 0)) : 0.0; };
  const auto response = [=](double f) {
    const auto wave = [&](double x) { return inside(x) * cos_pi(2 * f * x); };
    return 2 * integrate(wave, 0, radius, panels_for(radius, feature, f));
  };
  return {{}, radius, false, even(radius, inside), integral_from(radius, half), response};
}

bool is_integer(double x) { return x == std::floor(x); }

Kernel make_box(std::span<const double> p) {
  const double width = p[0], radius = width / 2;
  return {{},
          radius,
          is_integer(width),
          even(radius, [=](double) { return 1 / width; }),
          integral_from(radius, [=](double a) { return a / width; }),
          [=](double f) { return sinc(width * f); }};
}

Kernel make_tent(std::span<const double> p) {
  const double r = p[0];
  return {{},
          r,
          is_integer(r),
          even(r, [=](double a) { return (1 - a / r) / r; }),
          integral_from(r, [=](double a) { return (a - a * a / (2 * r)) / r; }),
          [=](double f) { return sinc(r * f) * sinc(r * f); }};
}

Kernel make_gaussian(std::span<const double> p) {
  const double sigma = p[0], extent = p[1];
  const double root_half = std::numbers::sqrt2 / 2;
  const double mass = error_function(extent * root_half);
  const double height = 1 / (sigma * 2.5066282746310005 * mass);  // σ √(2π)
  const auto inside = [=](double a) { return height * natural_exp(-a * a / (2 * sigma * sigma)); };
  Kernel kernel = by_quadrature(sigma * extent, sigma, inside);
  kernel.integral =
      integral_from(kernel.radius, [=](double a) { return error_function(a / sigma * root_half) / (2 * mass); });
  return kernel;
}

double cubic(const double (&c)[4], double x) { return ((c[3] * x + c[2]) * x + c[1]) * x + c[0]; }
double cubic_integral(const double (&c)[4], double x) {
  return (((c[3] / 4 * x + c[2] / 3) * x + c[1] / 2) * x + c[0]) * x;
}

struct Cubics {
  double inner[4], outer[4];  // on [0, 1) and [1, 2]
};

Kernel make_cubic(double b, double c) {
  const Cubics k = {{1 - b / 3, 0, -3 + 2 * b + c, 2 - 1.5 * b - c},
                    {4 * b / 3 + 4 * c, -2 * b - 8 * c, b + 5 * c, -b / 6 - c}};
  const auto inside = [=](double a) { return a < 1 ? cubic(k.inner, a) : cubic(k.outer, a); };
  const auto half = [=](double a) {
    return cubic_integral(k.inner, std::min(a, 1.0)) +
           (a > 1 ? cubic_integral(k.outer, a) - cubic_integral(k.outer, 1) : 0.0);
  };
  // The family is B-spline b + Hermite (1 - b) + c times a part with integral 0. Each has a closed-form transform,
  // which suffers from cancellation near f = 0; there the quadrature is exact to rounding.
  const auto response = [=](double f) {
    if (std::abs(f) < 0.125) {
      const auto wave = [&](double x) { return inside(x) * cos_pi(2 * f * x); };
      return 2 * (integrate(wave, 0, 1, 1) + integrate(wave, 1, 2, 1));
    }
    const double s1 = sinc(f), s2 = sinc(2 * f), s4 = sinc(4 * f), u = 1 / (pi * f * (pi * f));
    return b * (s1 * s1 * s1 * s1) + (1 - b) * (3 * u * (s1 * s1 - s2)) + c * (2 * u * (2 * s2 + s4 - 3 * s2 * s2));
  };
  return {{}, 2, true, even(2, inside), integral_from(2, half), response};
}

Kernel make_mitchell(std::span<const double> p) { return make_cubic(p[0], p[1]); }
Kernel make_catmull_rom(std::span<const double>) { return make_cubic(0, 0.5); }
Kernel make_b_spline(std::span<const double>) { return make_cubic(1, 0); }

Kernel make_lanczos(std::span<const double> p) {
  const double lobes = p[0];
  return by_quadrature(lobes, 1, [=](double a) { return sinc(a) * sinc(a / lobes); });
}
Kernel make_lanczos2(std::span<const double>) { return make_lanczos(std::vector<double>{2}); }
Kernel make_lanczos3(std::span<const double>) { return make_lanczos(std::vector<double>{3}); }

Kernel make_blackman_harris(std::span<const double> p) {
  static constexpr double term[] = {0.35875, 0.48829, 0.14128, 0.01168};
  const double r = p[0], height = 1 / (2 * r * term[0]);
  const auto inside = [=](double a) {
    double sum = term[0];
    for (int k = 1; k < 4; ++k) sum += term[k] * cos_pi(k * a / r);
    return height * sum;
  };
  const auto half = [=](double a) {
    double sum = term[0] * a;
    for (int k = 1; k < 4; ++k) sum += term[k] * r / (pi * k) * sin_pi(k * a / r);
    return height * sum;
  };
  const auto response = [=](double f) {
    double sum = term[0] * sinc(2 * r * f);
    for (int k = 1; k < 4; ++k) sum += term[k] / 2 * (sinc(2 * r * f - k) + sinc(2 * r * f + k));
    return 2 * r * height * sum;
  };
  // The transform is 0 at every f = k / (2r), k >= 4: at all integers if 2r is an integer of at least 4.
  return {{}, r, is_integer(2 * r) && r >= 2, even(r, inside), integral_from(r, half), response};
}

Kernel make_kaiser(std::span<const double> p) {
  const double r = p[0], beta = p[1], at_zero = bessel_i0(beta);
  return by_quadrature(r, std::min(1.0, r / (1 + beta / 4)), [=](double a) {
    const double u = 1 - a / r * (a / r);
    return sinc(a) * bessel_i0(beta * std::sqrt(std::max(0.0, u))) / at_zero;
  });
}

const Param lobes_param = real_param("lobes", "lobes on each side, its radius", 3, 1, 16);

}  // namespace

std::span<const KernelEntry> kernels() {
  static const std::vector<KernelEntry> table = {
      {"box",
       "the mean over a width",
       "area sampling: Catmull, SIGGRAPH 1978",
       {real_param("width", "in samples", 1, 0.01, 4096)},
       make_box},
      {"tent",
       "linear interpolation (Bartlett, triangle)",
       "the box with itself",
       {real_param("radius", "in samples", 1, 0.01, 4096)},
       make_tent},
      {"gaussian",
       "the bell of the normal distribution, cut off and scaled to integral 1",
       "Gauss 1809",
       {real_param("sigma", "standard deviation, in samples", 1, 0.05, 1000),
        real_param("extent", "radius in sigmas", 3, 1, 8)},
       make_gaussian},
      {"mitchell",
       "the cubic between blur, ringing and anisotropy",
       "Mitchell and Netravali, Reconstruction Filters in Computer Graphics, SIGGRAPH 1988",
       {real_param("b", "B", 1.0 / 3, -2, 2), real_param("c", "C", 1.0 / 3, -2, 2)},
       make_mitchell},
      {"catmull-rom",
       "the cubic that interpolates (B = 0, C = ½)",
       "Catmull and Rom, A class of local interpolating splines, 1974",
       {},
       make_catmull_rom},
      {"b-spline",
       "the cubic without negative lobes (B = 1, C = 0)",
       "Schoenberg, Contributions to the problem of approximation of equidistant data, 1946",
       {},
       make_b_spline},
      {"lanczos2",
       "sinc under the middle lobe of a sinc, 2 lobes",
       "Duchon, Lanczos Filtering in One and Two Dimensions, J. Applied Meteorology 18, 1979",
       {},
       make_lanczos2},
      {"lanczos3", "the same, 3 lobes", "Duchon 1979", {}, make_lanczos3},
      {"lanczos", "the same, any number of lobes", "Duchon 1979", {lobes_param}, make_lanczos},
      {"blackman-harris",
       "four cosines, side lobes 92 dB down",
       "Harris, On the use of windows for harmonic analysis with the DFT, Proc. IEEE 66(1), 1978",
       {real_param("radius", "in samples", 2, 0.5, 4096)},
       make_blackman_harris},
      {"kaiser",
       "sinc under Kaiser's window",
       "Kaiser, Nonrecursive digital filter design using the I0-sinh window function, ISCAS 1974",
       {real_param("radius", "in samples", 3, 1, 64), real_param("beta", "the window's shape", 6.5, 0, 40)},
       make_kaiser},
  };
  return table;
}

Kernel make_kernel(std::string_view text) {
  const auto spec = parse_spec("kernel", kernels(), text);
  Kernel kernel = spec.row.make(spec.settings.numbers());
  kernel.name = spec.text();
  return kernel;
}

Kernel stretched(Kernel kernel, double factor) {
  assert(factor > 0);
  return {kernel.name,
          kernel.radius * factor,
          kernel.is_partition_of_unity && is_integer(factor),
          [value = kernel.value, factor](double x) { return value(x / factor) / factor; },
          [integral = kernel.integral, factor](double x) { return integral(x / factor); },
          [response = kernel.response, factor](double f) { return response(f * factor); }};
}

std::vector<double> sampled(const Kernel& kernel) {
  auto reach = static_cast<int>(std::floor(kernel.radius));
  while (reach > 0 && kernel.value(reach) == 0) --reach;
  // The sum runs from the ends inwards, so that small values are added first, and pairs the two sides.
  std::vector<double> taps(static_cast<std::size_t>(2 * reach + 1));
  double sum = 0;
  for (int j = reach; j > 0; --j) {
    const double k = kernel.value(j);
    taps[static_cast<std::size_t>(reach - j)] = taps[static_cast<std::size_t>(reach + j)] = k;
    sum += 2 * k;
  }
  const double middle = taps[static_cast<std::size_t>(reach)] = kernel.value(0);
  sum += middle;
  for (double& t : taps) t /= sum;
  return taps;
}

double response_of_taps(std::span<const double> taps, double f) {
  assert(taps.size() % 2 == 1);
  const std::size_t middle = taps.size() / 2;
  double sum = 0;
  for (std::size_t i = 0; i < taps.size(); ++i)
    sum += taps[i] * cos_pi(2 * f * (static_cast<double>(i) - static_cast<double>(middle)));
  return sum;
}

}  // namespace zoneplate
