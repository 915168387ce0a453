// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"

namespace zoneplate {

/// A filter kernel: an even function of one variable that is 0 beyond `radius`.
///
/// In two dimensions the kernel is the product k(x) k(y). At a discontinuity its value is the mean of both sides.
///
/// Units     x in samples, frequency in cycles per sample; the kernels of the list have an integral near 1 (exactly 1
///           except Lanczos and Kaiser, which instead are 1 at 0 and 0 at the other integers).
/// Exact     the same bits on every machine; within 1e-12 of the definition.
struct Kernel {
  std::string name;  ///< the text that it was parsed from: "gaussian:sigma=2"
  double radius = 0;
  bool is_partition_of_unity = false;        ///< Σ_j k(x - j) = 1 for every x
  std::function<double(double x)> value;     ///< k(x)
  std::function<double(double x)> integral;  ///< ∫ k from -∞ to x
  std::function<double(double f)> response;  ///< ∫ k(x) cos(2πfx) dx: its Fourier transform, real because k is even
};

/// An entry of the list of kernels.
struct KernelEntry {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  std::vector<Param> params;
  Kernel (*make)(std::span<const double> params);  ///< makes all members except the name
};

/// box, tent, gaussian, mitchell, catmull-rom, b-spline, lanczos2, lanczos3, lanczos, blackman-harris, kaiser.
std::span<const KernelEntry> kernels();

/// Parses a kernel: `box`, `box:width=3`, `gaussian:sigma=2`, `mitchell:b=0.2,c=0.4`.
///
/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
Kernel make_kernel(std::string_view text);

/// The kernel stretched by `factor`, with the same integral: k(x / factor) / factor.
Kernel stretched(Kernel kernel, double factor);

/// k(j) at the integers, divided by their sum: the taps of a discrete filter. `box:width=2` gives ¼ ½ ¼.
///
/// Shape     2 r + 1 values, r <= radius, the middle one at r.
/// Exact     the sum is 1 within 1e-15; symmetric to the bit.
std::vector<double> sampled(const Kernel& kernel);

/// Σ_j taps[j] cos(2πf (j - middle)): the frequency response of symmetric taps, of period 1 in f.
///
/// Requires  an odd number of taps.
double response_of_taps(std::span<const double> taps, double f);

}  // namespace zoneplate
