// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace zoneplate {

/// A wave of period 1 with values in [-1, 1].
enum class Wave {
  Square,    ///< 1 on (0, ½), -1 on (½, 1), 0 at the jumps
  Sawtooth,  ///< rises from -1 to 1, 0 at the jump
  Triangle,  ///< 0 at 0, 1 at ¼, -1 at ¾
};

const char* name_of(Wave wave);
/// Errors    ErrorKind::Usage for another name than square, sawtooth, triangle.
Wave parse_wave(std::string_view name);

double wave_value(Wave wave, double x);

/// The coefficient b of the wave's harmonic n >= 1: wave(x) = Σ b_n sin(2πn x). All three waves are odd.
double harmonic(Wave wave, int n);

/// The sum of harmonics 1 to `highest`. Its overshoot at a jump converges to 8.949 % of the jump and does not vanish
/// (Gibbs phenomenon).
double partial_sum(Wave wave, int highest, double x);

/// The frequency in (-rate/2, rate/2] whose cosine and sine have the same samples as those of `frequency`.
///
/// A wheel of n spokes that turns by `frequency` spokes per frame appears to turn by apparent_frequency(frequency, 1).
double apparent_frequency(double frequency, double rate);

/// The frequency in [0, rate/2] to which `frequency` is aliased: |apparent_frequency|.
double folded_frequency(double frequency, double rate);

/// The positive frequencies up to `highest` that have the same samples as `frequency` at this rate, in ascending order.
std::vector<double> aliases_of(double frequency, double rate, double highest);

/// The contrast of a wave that moves by `cycles` periods during the exposure: |sinc(cycles)|.
double shutter_contrast(double cycles);

/// The band in which the copies of a spectrum of this bandwidth overlap if it is sampled at this rate; empty: low >=
/// high.
struct Band {
  double low = 0, high = 0;
};
Band overlap_of_copies(double bandwidth, double rate);

}  // namespace zoneplate
