// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// Convolution of images with kernels: out(x) = Σ_j kernel[j] in(x - (j - origin)), origin = size / 2 rounded down.
///
/// A kernel of odd size is centred; kernels are not scaled. Each channel of a `Linear` image, including alpha, is
/// filtered separately, as is correct for premultiplied colour; the result is not clamped.
struct ConvolveOptions {
  Border border = Border::Clamp;  ///< not Cut
};

/// Along rows, then along columns. Not empty: a single tap of 1 leaves a direction as it is.
///
/// Exact     sums in float in the order of the taps; error below (taps + 1) 2^-24 Σ|kernel| of the greatest value. The
///           same bits on every instruction set and number of threads.
/// Cost      a multiplication and an addition a tap, pixel and direction; 49 taps take some nine copies for both
/// (bench/).
/// `room` may be a plane of the same size whose memory becomes the result's: for one image after another.
Plane<float> convolve_separable(const Plane<float>& plane, std::span<const double> along_rows,
                                std::span<const double> along_columns, const ConvolveOptions& options = {},
                                Plane<float> room = {});
LinearImage convolve_separable(const LinearImage& image, std::span<const double> along_rows,
                               std::span<const double> along_columns, const ConvolveOptions& options = {},
                               LinearImage room = {});

/// By the definition, for any kernel.
///
/// Exact     sums in double, rounded once.
/// Cost      a multiplication and an addition a pixel and pixel of the kernel.
Plane<float> convolve(const Plane<float>& plane, const Plane<float>& kernel, const ConvolveOptions& options = {});
LinearImage convolve(const LinearImage& image, const Plane<float>& kernel, const ConvolveOptions& options = {});

/// The same by the convolution theorem: the product of the spectra.
///
/// The theorem is about periodic signals: it holds as it stands for `Wrap`, whose spectra have the image's own size,
/// and for `Zero` once the image is padded with zeros by the kernel's radius. It does not hold for `Clamp` and
/// `Reflect`, with which the result at the border depends on the position and not only on the distance: for them the
/// image is padded by its border first, and cropped afterwards, which gives their result too.
/// Exact     transforms and products in double, rounded once: within about 1e-15 Σ|kernel| of the greatest value.
/// Cost      O(n log n) for n pixels, whatever the kernel's size.
Plane<float> convolve_by_fourier(const Plane<float>& plane, const Plane<float>& kernel, Border border = Border::Clamp);
LinearImage convolve_by_fourier(const LinearImage& image, const Plane<float>& kernel, Border border = Border::Clamp);

/// The two-dimensional kernel along_columns ⊗ along_rows.
Plane<float> outer_product(std::span<const double> along_rows, std::span<const double> along_columns);

}  // namespace zoneplate
