// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// 10 log10(1 / mse); infinite for 0.
double psnr_of_mse(double mse);

/// Peak signal-to-noise ratio of codes over all measured pixels and the three colours; the peak is 1. Infinite if all
/// codes agree.
double peak_signal_to_noise(const Picture& reference, const Picture& test);

/// Peak signal-to-noise ratio of luma, in the full range of codes. If luma is coded in the studio range (16 to 235 of
/// 255, as in MATLAB's rgb2ycbcr and in video), the ratio to a peak of 255 is 20 log10(255 / 219) = 1.32 dB higher.
double luma_peak_signal_to_noise(const Picture& reference, const Picture& test, LumaWeights weights = rec709_luma);

/// The ratio of a sequence, computed from the mean of its frames' squared errors, so that one exact frame does not make
/// it infinite.
double pool_psnr(std::span<const double> frames);

}  // namespace zoneplate::metrics
