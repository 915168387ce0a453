// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// The roll-off of a filter from 1 to 0, as a function of u, the frequency over the cut-off frequency.
///
/// ideal: 1 below u = 1, 0 above; gaussian: 2^(-u²); butterworth: 1 / (1 + u^(2 order)). All are ½ at u = 1.
struct FilterShape {
  enum class Kind { Ideal, Gaussian, Butterworth } kind = Kind::Ideal;
  double order = 2;  ///< order of a Butterworth filter
};

/// Parses a shape: `ideal`, `gaussian`, `butterworth:order=4`.
///
/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
FilterShape parse_filter_shape(std::string_view text);

/// A filter of radial frequency √(fx² + fy²).
///
/// For Low, u is f / high; for Band, u is |f² - low high| / (f (high - low)), so that the response is 1 at √(low high)
/// and ½ at both ends. High and Stop are 1 minus the Low with cut-off `low` and 1 minus the Band.
///
/// Units     cycles per pixel; ½ is the Nyquist frequency, √½ the corner of the spectrum.
/// Requires  0 < low < high for Band and Stop; high > 0 for Low; low > 0 for High.
/// Source    Gonzalez and Woods, Digital Image Processing, ch. 4 (where a Gaussian is 0.607 at its cut-off).
struct FrequencyFilter {
  enum class Pass { Low, High, Band, Stop } pass = Pass::Low;
  FilterShape shape;
  double low = 0, high = 0.5;
};

/// The factor in [0, 1] for frequency f >= 0.
double response(const FrequencyFilter& filter, double f);

/// The plane with each frequency multiplied by its response.
///
/// Edges     Border::Wrap: the plane is one period of the signal. Border::Reflect: the plane is mirrored to twice its
///           size and cropped afterwards, so that opposite edges do not affect each other.
/// Requires  one of these two borders: the others do not extend to a periodic signal.
Plane<float> filtered(const Plane<float>& plane, const FrequencyFilter& filter, Border border = Border::Wrap);
LinearImage filtered(const LinearImage& image, const FrequencyFilter& filter, Border border = Border::Wrap);

}  // namespace zoneplate
