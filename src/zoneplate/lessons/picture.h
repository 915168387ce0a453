// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/render/render.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate::lessons {

// Functions that create the images of lessons.

/// Renders the scene with its own camera (or the whole-scene view), opaque, in linear light over the default dark grey.
LinearImage shoot(const Scene& scene, const std::string& method, int width, int height, RenderCounts* counts = nullptr,
                  ShadingFrequency frequency = ShadingFrequency::Fragment);

/// The same with these options, of which width and height are used as well.
LinearImage shoot(const Scene& scene, const std::string& method, const RenderOptions& options,
                  const MipOptions& mips = {}, RenderCounts* counts = nullptr);

/// The camera of `shoot`.
Camera camera_of(const Scene& scene, int width, int height);

/// The built-in scene of this name and parameters.
Scene scene_of(const std::string& text);

Rgba8Image shown(const LinearImage& light);

/// Encodes linear light in [0, 1] as greys.
Rgba8Image shown(const Plane<float>& light);

/// A reduced zone plate without its outermost `seam` pixels: at its edges the waves of the Nyquist frequency are
/// discontinuous, which disturbs filters.
Plane<float> inside(const Plane<float>& plate);
inline constexpr int seam = 5;

/// The luminance of every pixel of an opaque image.
Plane<float> luminance_of(const LinearImage& light);

/// The centred spectrum, logarithmic over `range_db`, in false colours.
Rgba8Image spectrum_picture(const Spectrum& spectrum, double range_db = 100);

/// A square crop around a position, enlarged `factor` times to `side` pixels and moved inside the image; the last
/// pixels are cut off if `side` is not a multiple of `factor`.
Rgba8Image crop_of(const Rgba8Image& picture, int centre_x, int centre_y, int factor, int side);

/// The image with an outline around that crop.
Rgba8Image marked(Rgba8Image picture, int centre_x, int centre_y, int factor, int side);

/// A sign such as = between two images of this height, on the figure's background.
Rgba8Image sign_picture(const std::string& sign, int height, const FigureStyle& style);

/// The plot at this size; below the width for which its letters are designed, a plot of that width is reduced. Plots
/// with few ticks and a short key have room for larger letters: a smaller width.
Panel plot_panel(Plot plot, int width, int height, std::string caption, int designed_width = 720);

/// Root mean square difference.
double rms_difference(const Plane<float>& a, const Plane<float>& b);

/// Formats a number with a true minus sign: "−12.3".
std::string number(double value, int decimals);

/// Formats a count with separators: "1,234,567".
std::string counted(std::uint64_t count);

}  // namespace zoneplate::lessons
