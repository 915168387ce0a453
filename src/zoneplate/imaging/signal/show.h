// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/math/vec.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate {

// Display of images and spectra in the figures of `zoneplate signal`.

/// The longest side of a panel's image.
constexpr int panel_px = 512;

/// Converts premultiplied linear light or display codes to an image. Values below 0 or above 1 are clamped.
Rgba8Image shown(const LinearImage& image, bool uses_codes);

/// Converts differences to an image: 0 is mid-grey, the code is ½ + value / 2, opaque.
Rgba8Image shown_around_grey(const LinearImage& image);

/// Rec.709 luminance of the values, over black.
Plane<float> luminance(const LinearImage& image);

/// The scale of displayed magnitudes: white is `peak`, black `range_db` decibels below it.
struct MagnitudeScale {
  double range_db = 80;
  double peak = 0;  ///< a magnitude |X|; 0: that of the spectrum's own strongest wave
};

/// The greatest |X| without the mean; for a constant, the mean.
double strongest_magnitude(const Spectrum& spectrum);

/// Images of a spectrum with frequency 0 in the middle, one bin per pixel. Magnitudes are painted with magma, whose
/// lightness is uniform in decibels; phases with a circle of colours: white 0, orange a quarter turn, black a half,
/// blue three quarters.
Rgba8Image paint_magnitude(const Spectrum& spectrum, const MagnitudeScale& scale = {});
Rgba8Image paint_phase(const Spectrum& spectrum);

/// The magnitude at the size of a panel: the maximum of each block of bins of a large spectrum, so that no line is
/// lost.
Rgba8Image magnitude_panel(const Spectrum& spectrum, const MagnitudeScale& scale = {});

/// The size at which an image of width × height pixels is displayed: enlarged by an integer factor, or reduced to
/// panel_px.
int2 panel_size(int width, int height);

/// The image at the size of a panel: with repeated pixels, or reduced by a filter.
Rgba8Image fitted(const Rgba8Image& picture);

/// The phase at the size of a panel; for a large spectrum the central region, because phases have no mean.
Rgba8Image phase_panel(const Spectrum& spectrum);

/// The name of the input in a figure: a file's name without its folders.
std::string title_of(const std::string& input);

}  // namespace zoneplate
