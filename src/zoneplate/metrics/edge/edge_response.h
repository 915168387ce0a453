// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The response of an image to one straight edge: the result of its sampling and filter for a step.
///
/// Units     pixels along the edge's normal; frequencies in cycles per pixel, along the normal too.
struct EdgeResponse {
  double angle_deg = 0;           ///< between the edge and the nearer axis of the image
  std::vector<double> distance;   ///< distances of the samples of `spread`: 4 per pixel, 0 on the edge
  std::vector<double> spread;     ///< the edge spread function, from about 0 to about 1
  std::vector<double> frequency;  ///< 0 to 1
  std::vector<double> transfer;   ///< the modulation transfer function, 1 at frequency 0
  double half_transfer = 0;       ///< MTF50: the frequency at which `transfer` first falls to ½; 1 if it does not
  double nyquist_transfer = 0;    ///< `transfer` at ½, the aliased energy
  double rise = 0;                ///< distance from 10 % to 90 % of the step
  double overshoot = 0;           ///< the greater of the maximum above 1 and the minimum below 0
};

/// Measures the one straight edge of an image, in luminance of linear light.
///
/// Returns nothing without such an edge: no contrast, an edge so nearly parallel to an axis that all rows sample the
/// same distances, or less than 4 pixels on either side of it.
/// Exact     the transfer of an edge drawn with a known filter is found within 0.01 up to 0.7 cycles per pixel; the
///           rise is within 0.06 pixel.
/// Source    ISO 12233:2017, annex D (edge-based spatial frequency response); in this implementation distances are
///           measured along the normal, and the transfer of the bins is divided out together with that of the
///           difference.
std::optional<EdgeResponse> measure_edge(const LinearImage& image);

}  // namespace zoneplate::metrics
