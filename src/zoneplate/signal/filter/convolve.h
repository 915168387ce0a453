// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// Convolution of images with kernels: out(x) = Σ_j kernel[j] in(x - (j - origin)), origin = size / 2 rounded down.
///
/// The origin of a kernel of odd size is its centre; kernels are not normalized. Each channel of a `Linear` image,
/// including alpha, is filtered separately, which is correct for premultiplied colour; the result is not clamped.
struct ConvolveOptions {
  Border border = Border::Clamp;  ///< not Cut
};

/// Convolves along rows, then along columns. Kernels are not empty; a single tap of 1 is the identity.
///
/// `room` may be a plane of the same size whose memory is reused for the result, for a sequence of images.
/// Exact     sums in float in the order of the taps; error below (taps + 1) 2^-24 Σ|kernel| times the greatest value.
///           The same bits on every instruction set and number of threads.
/// Cost      one multiplication and one addition per tap, pixel and direction; 49 taps in both directions take about as
///           long as nine copies (bench/).
Plane<float> convolve_separable(const Plane<float>& plane, std::span<const double> along_rows,
                                std::span<const double> along_columns, const ConvolveOptions& options = {},
                                Plane<float> room = {});
LinearImage convolve_separable(const LinearImage& image, std::span<const double> along_rows,
                               std::span<const double> along_columns, const ConvolveOptions& options = {},
                               LinearImage room = {});

/// Convolves by the definition, with any kernel.
///
/// Exact     sums in double, rounded once.
/// Cost      one multiplication and one addition per pixel of the image and pixel of the kernel.
Plane<float> convolve(const Plane<float>& plane, const Plane<float>& kernel, const ConvolveOptions& options = {});
LinearImage convolve(const LinearImage& image, const Plane<float>& kernel, const ConvolveOptions& options = {});

/// Convolves by the convolution theorem: as the product of the spectra.
///
/// The theorem is about periodic signals. It applies directly to `Wrap`, whose spectra have the image's own size, and
/// to `Zero` once the image is padded with zeros by the kernel's radius. It does not apply to `Clamp` and `Reflect`,
/// with which the result near the border depends on the position; for these the image is padded according to its border
/// and cropped afterwards, which gives the same result.
/// Exact     transforms and products in double, rounded once: within about 1e-15 Σ|kernel| times the greatest value.
/// Cost      O(n log n) for n pixels, independently of the kernel's size.
Plane<float> convolve_by_fourier(const Plane<float>& plane, const Plane<float>& kernel, Border border = Border::Clamp);
LinearImage convolve_by_fourier(const LinearImage& image, const Plane<float>& kernel, Border border = Border::Clamp);

/// The two-dimensional kernel along_columns ⊗ along_rows.
Plane<float> outer_product(std::span<const double> along_rows, std::span<const double> along_columns);

}  // namespace zoneplate
