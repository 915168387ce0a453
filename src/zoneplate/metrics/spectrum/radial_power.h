// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/metrics/picture.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate::metrics {

/// The spectrum of a plane minus its mean, with a Hann window in x and y, scaled so that the expected power of white
/// noise in every bin is its variance.
///
/// Edges     the window suppresses the cross of the image's border; the mean is weighted by the window too.
Spectrum windowed_spectrum(const Plane<double>& plane);

/// Power as a function of the radial frequency.
struct RadialPower {
  /// Middles of the rings, which are one bin of the shorter side wide, in cycles per pixel.
  std::vector<double> frequency;
  std::vector<double> power;  ///< the mean of |spectrum|² over a ring; empty rings are omitted
};

RadialPower radial_power_of(const Spectrum& spectrum);

/// The contribution of a band of frequencies to the mean square: Σ |spectrum|² / pixels over low <= |f| < high.
double band_power(const Spectrum& spectrum, double low, double high);

}  // namespace zoneplate::metrics
