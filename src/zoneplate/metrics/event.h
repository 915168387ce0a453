// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "zoneplate/metrics/metric.h"

namespace zoneplate::metrics {

/// What is left of an earlier image after an event: an object that is gone, a light that is switched.
///
/// An event is a change by more than an eighth of the range of codes, in any channel, between the first two frames of
/// the reference, after which the reference stays constant, within 1/64, in all further frames. `remains[k]` is the
/// share of the earlier light in frame k of the test: the projection of its error onto the change,
/// Σ (I_k − R_k) · (R_0 − R_1) / Σ |R_0 − R_1|², in linear light over the pixels of the event. remains[0] is 1.
/// Exponential history of weight 1 − a has (1 − a)^k; errors that do not correlate with the change, such as aliasing,
/// do not count.
struct EventResponse {
  std::vector<double> remains;  ///< by frame; negative: the test overshoots
  Plane<float> map;             ///< |I_1 − R_1| at the pixels of the event, at most 1, and 0 elsewhere
};

/// The frames of a window that begins with the last frame before the event.
constexpr int event_window = 8;

/// Nothing if fewer than a thousandth of the pixels belong to an event.
std::optional<EventResponse> event_response(Frames reference, Frames test);

/// The number of frames until the share has fallen to `share`, interpolated exponentially between frames. Beyond the
/// window the mean rate of its frames is extrapolated: infinite if the share has not fallen.
double frames_until(const std::vector<double>& remains, double share);

}  // namespace zoneplate::metrics
