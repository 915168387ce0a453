// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/plane.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate {

/// Images and statistics of a spectrum. In the images frequency 0 is at pixel (width / 2, height / 2), rounded down; fx
/// increases to the right and fy downwards, one bin per pixel.
///
/// Exact     the same bits on every machine and number of threads.

/// log |X|, mapped so that the greatest magnitude is 1, and `range_db` decibels below it and less is 0.
Plane<float> centred_log_magnitude(const Spectrum& spectrum, double range_db = 120);

/// The angle of X in [-π, π].
Plane<float> centred_phase(const Spectrum& spectrum);

/// The mean power |X|² / (w h)² in rings of equal width of √(fx² + fy²), where fx and fy are in cycles per pixel.
struct RadialProfile {
  double ring_width = 0;           ///< in cycles per pixel; ring i covers [i, i + 1) ring_width
  std::vector<double> power;       ///< 0 for an empty ring; the rings extend to the corners at √½
  std::vector<std::int64_t> bins;  ///< number of bins of the ring
};

/// A profile of `rings` rings up to the Nyquist frequency ½, and further rings of the same width up to the corners.
RadialProfile radial_profile(const Spectrum& spectrum, int rings);

/// The contribution of radial frequencies in [low, high), in cycles per pixel, to the plane's mean square. The
/// contribution of [0, 1) is the whole mean square, by Parseval's theorem.
double energy_between(const Spectrum& spectrum, double low, double high);

}  // namespace zoneplate
