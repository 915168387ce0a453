#pragma once

#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/render/render.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate::cli {

// What lessons make their pictures with.

/// The scene as the renderer gives it through the scene's own view (or the whole-scene one), opaque, in linear light
/// over the usual dark grey.
LinearImage shoot(const Scene& scene, const std::string& method, int width, int height, RenderCounts* counts = nullptr);

/// The camera through which `shoot` looks.
Camera camera_of(const Scene& scene, int width, int height);

/// The built-in scene of a text.
Scene scene_of(const std::string& text);

Rgba8Image shown(const LinearImage& light);

/// Linear light in [0, 1] as greys.
Rgba8Image shown(const Plane<float>& light);

/// A reduced zone plate without its outermost `seam` pixels: at its edges waves of the Nyquist frequency meet their
/// mirror images, and filters see that.
Plane<float> inside(const Plane<float>& plate);
inline constexpr int seam = 5;

/// The luminance of every pixel of an opaque picture.
Plane<float> luminance_of(const LinearImage& light);

/// The centred spectrum, logarithmic over `range_db`, in false colours: what is no picture does not look like one.
Rgba8Image spectrum_picture(const Spectrum& spectrum, double range_db = 100);

/// A square crop around a place, `factor` times enlarged to `side` pixels, kept inside of the picture; the last pixels
/// are cut where `side` is no multiple.
Rgba8Image crop_of(const Rgba8Image& picture, int centre_x, int centre_y, int factor, int side);

/// The picture with the outline of that crop drawn into it.
Rgba8Image marked(Rgba8Image picture, int centre_x, int centre_y, int factor, int side);

/// A sign such as = between two pictures of this height, on paper.
Rgba8Image sign_picture(const std::string& sign, int height, const FigureStyle& style);

/// The plot at this size; below the size that its letters are made for, as that one made smaller.
Rgba8Image plot_at(const Plot& plot, int width, int height);

/// Root of the mean squared difference.
double rms_difference(const Plane<float>& a, const Plane<float>& b);

/// "−12.3", with a true minus sign.
std::string number(double value, int decimals);

/// "1,234,567".
std::string counted(std::uint64_t count);

}  // namespace zoneplate::cli
