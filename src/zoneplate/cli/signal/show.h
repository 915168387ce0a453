// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/math/vec.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate::cli {

// Display of images and spectra in the figures of `zoneplate signal`.

/// The greatest side of a panel's image.
constexpr int panel_px = 512;

/// Linear light, or display codes, premultiplied, as a image. What is below 0 or above 1 is clamped.
Rgba8Image shown(const LinearImage& image, bool uses_codes);

/// An image of differences: 0 is mid-grey, code ½ + value / 2, opaque.
Rgba8Image shown_around_grey(const LinearImage& image);

/// Rec.709 luminance of the working numbers, on black.
Plane<float> luminance(const LinearImage& image);

/// The scale of displayed magnitudes: white is `peak`, black `range_db` decibels below it.
struct MagnitudeScale {
  double range_db = 80;
  double peak = 0;  ///< a magnitude |X|; 0: the strongest wave of the spectrum itself
};

/// The greatest |X| but for the mean; of a constant the mean.
double strongest_magnitude(const Spectrum& spectrum);

/// Frequency 0 in the middle, one bin a pixel. Magnitudes in magma, each decibel a step of equal lightness; phases in a
/// ring of colours: white 0, orange a quarter turn, black a half, blue three quarters.
Rgba8Image paint_magnitude(const Spectrum& spectrum, const MagnitudeScale& scale = {});
Rgba8Image paint_phase(const Spectrum& spectrum);

/// The same at the size of a panel: of a large spectrum the strongest of each block of bins, so that no line is lost.
Rgba8Image magnitude_panel(const Spectrum& spectrum, const MagnitudeScale& scale = {});

/// The size at which an image of width × height pixels is shown: enlarged by a whole factor, or reduced to panel_px.
int2 panel_size(int width, int height);

/// The image at the size of a panel: pixels repeated, or reduced by a filter.
Rgba8Image fitted(const Rgba8Image& picture);

/// The phase at the size of a panel; of a large spectrum the middle, because phases have no mean.
Rgba8Image phase_panel(const Spectrum& spectrum);

/// The name of the input in a figure: a file's name without its folders.
std::string title_of(const std::string& input);

}  // namespace zoneplate::cli
