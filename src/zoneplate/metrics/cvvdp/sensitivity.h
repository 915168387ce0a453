// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace zoneplate::metrics {

/// Contrast sensitivity (the reciprocal of the contrast threshold) at one frequency, as a function of the adapting
/// luminance.
///
/// Channels  0 luminance, 1 red-green, 2 violet-yellow, 3 luminance that changes at 5 Hz.
/// Units     luminance in cd/m², frequency in cycles per degree; both are clamped to the table, 0.005 to 10000 and 0.1
///           to 64.
/// Source    castleCSF: Ashraf, Mantiuk, Chapiro, Wuerger, castleCSF: A Contrast Sensitivity Function of Color, Area,
///           Spatiotemporal frequency, Luminance and Eccentricity, Journal of Vision 24(4), 2024.
class Sensitivity {
 public:
  Sensitivity(int channel, double cycles_per_degree);
  double at(double luminance) const;
  double at_log(double log10_luminance) const;

 private:
  std::array<double, 32> logs_{};  // natural logarithms, in equal steps of log luminance
};

}  // namespace zoneplate::metrics
