// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/metrics/metric.h"

namespace zoneplate::metrics {

/// Pixels per degree of visual angle at a distance of 0.7 m from a display 0.7 m wide with 3840 pixels.
constexpr double default_pixels_per_degree = 67.02064327658226;

/// FLIP: at each pixel, the difference that a viewer notices when two images alternate in place.
///
/// Space     linear light of a display, over black; clamped to [0, 1].
/// Requires  equal sizes; pixels_per_degree > 0.
/// Edges     the border pixel is repeated. Symmetric; exactly 0 if the images agree within the filters' reach.
/// Units     0 (no difference) to 1 (the greatest).
/// Cost      about 600 multiplications per pixel at the default 67 pixels per degree; memory only for tiles.
/// Source    Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, FLIP: A Difference Evaluator for
///           Alternating Images, HPG 2020.
Plane<float> flip_map(const LinearImage& reference, const LinearImage& test, double pixels_per_degree);

/// The exposures, as powers of two, at which images of unbounded light are compared: from that at which the brightest
/// pixel is just below white to that at which the median one is.
///
/// Source    Andersson, Nilsson, Shirley, Akenine-Möller, Visualizing Errors in Rendered High Dynamic Range Images,
///           Eurographics 2021.
std::vector<double> flip_exposures(const LinearImage& reference);

/// The greatest FLIP at each pixel over the reference's exposures, each tone-mapped with the ACES curve.
///
/// Edges     negative light counts as 0. Not symmetric: only the reference determines the exposures.
Plane<float> hdr_flip_map(const LinearImage& reference, const LinearImage& test, double pixels_per_degree);

/// The score of a FLIP map: its mean as the value, and additionally the weighted quartiles and the weighted median
/// (pixels up to these values contain a quarter, a half and three quarters of the total error), the 99th percentile,
/// the minimum and the maximum. Pixels that the reference ignores do not count, and are 0 in the map.
Score score_of_flip(Plane<float> map, const Picture& reference = {});

}  // namespace zoneplate::metrics
