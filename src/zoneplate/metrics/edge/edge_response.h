// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The response of an image to one straight edge: the result of its sampling and filter for a step.
///
/// Units     pixels along the edge's normal; frequencies in cycles per pixel, along it too.
struct EdgeResponse {
  double angle_deg = 0;           ///< between the edge and the nearer axis of the image
  std::vector<double> distance;   ///< where the spread was sampled: 4 places a pixel, 0 on the edge
  std::vector<double> spread;     ///< the edge spread function, from about 0 to about 1
  std::vector<double> frequency;  ///< 0 to 1
  std::vector<double> transfer;   ///< the modulation transfer function, 1 at frequency 0
  double half_transfer = 0;       ///< MTF50: where `transfer` first falls to ½; 1 if it does not
  double nyquist_transfer = 0;    ///< `transfer` at ½: what can alias
  double rise = 0;                ///< from 10 % to 90 % of the step
  double overshoot = 0;           ///< the greater of what the spread goes past 1 and below 0
};

/// Measures the one straight edge of an image from its luminance in linear light.
///
/// Nothing where there is no such edge: no contrast, an edge so nearly along an axis that its rows all sample the same
/// distances, or less than 4 pixels on either side of it.
/// Exact     the transfer of an edge drawn with a known filter is found within 0.01 up to 0.7 cycles per pixel; the
/// rise is
///           within 0.06 pixel.
/// Source    ISO 12233:2017, annex D (edge-based spatial frequency response); here distances are taken along the
///           normal, and the transfer of the bins is divided out with that of the difference.
std::optional<EdgeResponse> measure_edge(const LinearImage& image);

}  // namespace zoneplate::metrics
