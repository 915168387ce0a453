// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// How a filter falls from 1 to 0, as a function of u, the frequency over its cut-off.
///
/// ideal: 1 below u = 1, 0 above; gaussian: 2^(-u²); butterworth: 1 / (1 + u^(2 order)). All are ½ at u = 1.
struct FilterShape {
  enum class Kind { Ideal, Gaussian, Butterworth } kind = Kind::Ideal;
  double order = 2;  ///< of Butterworth
};

/// `ideal`, `gaussian`, `butterworth:order=4`.
///
/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
FilterShape parse_filter_shape(std::string_view text);

/// A filter of radial frequency √(fx² + fy²).
///
/// u is f / high for Low, |f² - low high| / (f (high - low)) for Band: the low-pass's shape again, 1 at √(low high) and
/// ½ at both ends. High and Stop are 1 minus the Low of cut-off `low` and the Band.
///
/// Units     cycles per pixel; ½ is the Nyquist frequency, √½ the corner of the spectrum.
/// Requires  0 < low < high for Band and Stop; high > 0 for Low; low > 0 for High.
/// Source    Gonzalez and Woods, Digital Image Processing, ch. 4 (theirs is 0.607 at the cut-off of a Gaussian).
struct FrequencyFilter {
  enum class Pass { Low, High, Band, Stop } pass = Pass::Low;
  FilterShape shape;
  double low = 0, high = 0.5;
};

/// The factor in [0, 1] for frequency f >= 0.
double response(const FrequencyFilter& filter, double f);

/// The plane with each frequency multiplied by its response.
///
/// Edges     Border::Wrap: the plane is one period, as the transform has it. Border::Reflect: it is mirrored to twice
///           its size first and cut again, so that opposite edges do not bleed into one another.
/// Requires  one of these two border rules: nothing else can be continued without end.
Plane<float> filtered(const Plane<float>& plane, const FrequencyFilter& filter, Border border = Border::Wrap);
LinearImage filtered(const LinearImage& image, const FrequencyFilter& filter, Border border = Border::Wrap);

}  // namespace zoneplate
