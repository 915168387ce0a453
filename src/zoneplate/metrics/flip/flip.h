// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/metrics/metric.h"

namespace zoneplate::metrics {

/// Pixels in a degree of view for an eye 0.7 m from a screen 0.7 m wide with 3840 pixels.
constexpr double usual_pixels_per_degree = 67.02064327658226;

/// FLIP: at each pixel, how much a viewer notices when two images alternate in place.
///
/// Space     linear light of a screen, on black; clamped to [0, 1].
/// Requires  equal sizes; pixels_per_degree > 0.
/// Edges     the border pixel is repeated. Symmetric; exactly 0 wherever the images agree within the filters' reach.
/// Units     0 (no difference) to 1 (the greatest).
/// Cost      about 600 multiplications a pixel at the usual 67 pixels per degree; memory for tiles only.
/// Source    Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, FLIP: A Difference Evaluator for
///           Alternating Images, HPG 2020.
Plane<float> flip_map(const LinearImage& reference, const LinearImage& test, double pixels_per_degree);

/// The exposures, as powers of two, at which an image of unbounded light is looked at: from where its brightest
/// pixel is just below white to where its median one is.
///
/// Source    Andersson, Nilsson, Shirley, Akenine-Möller, Visualizing Errors in Rendered High Dynamic Range Images,
///           Eurographics 2021.
std::vector<double> flip_exposures(const LinearImage& reference);

/// The greatest FLIP at each pixel over the reference's exposures, each tone mapped by the ACES curve.
///
/// Edges     negative light counts as none. Not symmetric: the reference alone chooses the exposures.
Plane<float> hdr_flip_map(const LinearImage& reference, const LinearImage& test, double pixels_per_degree);

/// A FLIP map with its mean as value, and additionally the weighted quartiles and the weighted median (a quarter, a
/// half and three quarters of all error are in pixels up to them), the 99th percentile, the minimum and the maximum.
Score score_of_flip(Plane<float> map);

}  // namespace zoneplate::metrics
