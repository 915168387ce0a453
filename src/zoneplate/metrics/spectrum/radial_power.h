// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/metrics/picture.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate::metrics {

/// The spectrum of a plane less its mean, under a Hann window in x and y, scaled so that white noise has in every bin
/// the expected power of its variance.
///
/// Edges     the window takes out the cross that the image's border would draw; the mean is taken under it too.
Spectrum windowed_spectrum(const Plane<double>& plane);

/// Power over frequency, whatever the direction.
struct RadialPower {
  std::vector<double> frequency;  ///< the middles of rings one bin of the shorter side wide, in cycles per pixel
  std::vector<double> power;      ///< the mean of |spectrum|² over a ring; rings without a bin are left out
};

RadialPower radial_power_of(const Spectrum& spectrum);

/// What a band of frequencies holds of the mean square: Σ |spectrum|² / pixels over low <= |f| < high.
double band_power(const Spectrum& spectrum, double low, double high);

}  // namespace zoneplate::metrics
