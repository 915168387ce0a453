// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/render/render.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate::cli {

// Functions with which lessons make their images.

/// Renders the scene with its own camera (or the whole-scene view), opaque, in linear light over the default dark grey.
LinearImage shoot(const Scene& scene, const std::string& method, int width, int height, RenderCounts* counts = nullptr,
                  ShadingFrequency frequency = ShadingFrequency::Fragment);

/// The same with any options.
LinearImage shoot(const Scene& scene, const std::string& method, const RenderOptions& options,
                  RenderCounts* counts = nullptr);

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

/// A square crop around a position, enlarged `factor` times to `side` pixels and kept inside the image; the last pixels
/// are cut if `side` is no multiple of `factor`.
Rgba8Image crop_of(const Rgba8Image& picture, int centre_x, int centre_y, int factor, int side);

/// The image with the outline of that crop.
Rgba8Image marked(Rgba8Image picture, int centre_x, int centre_y, int factor, int side);

/// A sign such as = between two images of this height, on the figure's background.
Rgba8Image sign_picture(const std::string& sign, int height, const FigureStyle& style);

/// The plot at this size; below the minimum size of its letters, the plot of that size reduced.
Rgba8Image plot_at(const Plot& plot, int width, int height);

/// Root of the mean squared difference.
double rms_difference(const Plane<float>& a, const Plane<float>& b);

/// "−12.3", with a true minus sign.
std::string number(double value, int decimals);

/// "1,234,567".
std::string counted(std::uint64_t count);

}  // namespace zoneplate::cli
