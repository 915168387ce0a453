// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The structural similarity of two grey images with values in [0, 1]; NaN if no window is measured.
struct Similarity {
  double ssim = 1;      ///< mean of luminance × contrast-structure
  double contrast = 1;  ///< mean of contrast-structure, used by the finer scales of MS-SSIM
  Plane<float> map;     ///< SSIM at each pixel, in [-1, 1]
};

/// The window of means, variances and the covariance.
struct SimilarityWindow {
  /// Side of a uniform window in pixels, 2 to 11; 0: a Gaussian of sigma 1.5 in 11 × 11 pixels.
  int side = 0;
  bool is_unbiased = false;  ///< variances and covariance are divided by n - 1, for a window of n pixels
};

/// Structural similarity, by default with the Gaussian window of the paper and biased moments. Other implementations
/// use uniform windows of 7 (scikit-image, with unbiased moments) or 8 pixels a side (ffmpeg, at every fourth pixel).
///
/// `is_ignored`: 1 at pixels whose windows do not count, and whose map is 1; empty if there are none.
/// Requires  equal sizes, at least 11 × 11.
/// Edges     for the map, the image is mirrored at its border (the edge pixel is repeated); the means are over the
///           pixels whose window is inside the image; a window of even side extends one pixel farther to the right and
///           below. Symmetric; exactly 1 where the images agree.
/// Source    Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment: From Error Visibility to Structural Similarity,
///           IEEE TIP 13(4), 2004.
Similarity structural_similarity(const Plane<double>& reference, const Plane<double>& test,
                                 SimilarityWindow window = {}, const Plane<std::uint8_t>& is_ignored = {});

/// MS-SSIM over five scales: each scale is the mean of 2 × 2 pixels of the previous one (a last odd row or column is
/// omitted). The result is the product of contrast^weight over the scales, and of luminance at the last one. A negative
/// mean counts as 0. A pixel of a coarser scale is ignored if all of its four pixels are.
///
/// Requires  equal sizes, at least 176 × 176 (11 at the last scale).
/// Source    Wang, Simoncelli, Bovik, Multiscale Structural Similarity for Image Quality Assessment, Asilomar 2003.
double multiscale_similarity(const Plane<double>& reference, const Plane<double>& test,
                             Plane<std::uint8_t> is_ignored = {});

}  // namespace zoneplate::metrics
