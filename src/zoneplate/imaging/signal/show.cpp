// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/show.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "zoneplate/base/utf8.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/metrics/picture.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/fourier/spectrum.h"
#include "zoneplate/signal/functions.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate {
namespace {

std::uint8_t code8(double v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0, 1.0) * 255 + 0.5); }

/// The maximum of the values that fall on each pixel of a smaller plane.
Plane<float> max_in(const Plane<float>& plane, int2 size) {
  Plane<float> out(size.x, size.y);
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      float& v = out(x * size.x / plane.width(), y * size.y / plane.height());
      v = std::max(v, plane(x, y));
    }
  return out;
}

// The dynamic range that is kept before a spectrum is rescaled: all that doubles represent of an image.
constexpr double whole_range_db = 400;

double power_of(Complex z) { return z.real() * z.real() + z.imag() * z.imag(); }

double max_power(const Spectrum& spectrum, bool with_mean) {
  double greatest = 0;
  for (std::size_t i = with_mean ? 0 : 1; i < spectrum.half.values().size(); ++i)
    greatest = std::max(greatest, power_of(spectrum.half.values()[i]));
  return greatest;
}

// Levels that are 1 at the scale's peak and 0 at its end.
Plane<float> levels_of(const Spectrum& spectrum, const MagnitudeScale& scale) {
  Plane<float> levels = centred_log_magnitude(spectrum, whole_range_db);
  const double peak = scale.peak > 0 ? scale.peak : strongest_magnitude(spectrum);
  const double own = max_power(spectrum, true);
  if (own == 0 || peak == 0) return Plane<float>(levels.width(), levels.height());
  const double above = 10 / std::numbers::ln10 * natural_log(own / (peak * peak));
  metrics::for_rows(levels.height(), [&](int y) {
    for (float& v : levels.row(y))
      v = static_cast<float>(1 + ((static_cast<double>(v) - 1) * whole_range_db + above) / scale.range_db);
  });
  return levels;
}

int greater_side(int width, int height) { return std::max({1, width, height}); }

}  // namespace

Rgba8Image shown(const LinearImage& image, bool uses_codes) {
  if (!uses_codes) return quantize8(metrics::make_picture(image).display);
  DisplayImage codes(image.width(), image.height());
  std::ranges::transform(image.values(), codes.values().begin(), [](const Linear& c) {
    return c.a > 0 ? Display{c.r / c.a, c.g / c.a, c.b / c.a, c.a} : Display{0, 0, 0, 0};
  });
  return quantize8(codes);
}

Rgba8Image shown_around_grey(const LinearImage& image) {
  DisplayImage codes(image.width(), image.height());
  std::ranges::transform(image.values(), codes.values().begin(), [](const Linear& c) {
    return Display{0.5f + c.r / 2, 0.5f + c.g / 2, 0.5f + c.b / 2, 1};
  });
  return quantize8(codes);
}

Plane<float> luminance(const LinearImage& image) {
  Plane<float> out(image.width(), image.height());
  metrics::for_rows(image.height(), [&](int y) {
    std::ranges::transform(image.row(y), out.row(y).begin(), [](const Linear& c) {
      return static_cast<float>(0.2126 * static_cast<double>(c.r) + 0.7152 * static_cast<double>(c.g) +
                                0.0722 * static_cast<double>(c.b));
    });
  });
  return out;
}

double strongest_magnitude(const Spectrum& spectrum) {
  const double power = max_power(spectrum, false);
  // Rounding leaves a small magnitude in every bin of a constant.
  const double mean = power_of(spectrum.half.empty() ? Complex{} : spectrum.half(0, 0));
  return std::sqrt(power > 1e-24 * mean ? power : mean);
}

Rgba8Image paint_magnitude(const Spectrum& spectrum, const MagnitudeScale& scale) {
  return metrics::paint_magma(levels_of(spectrum, scale));
}

Rgba8Image paint_phase(const Spectrum& spectrum) {
  struct Color {
    double r, g, b;
  };
  static constexpr Color ring[] = {{0.97, 0.97, 0.97}, {0.9, 0.45, 0.05}, {0.05, 0.05, 0.05}, {0.1, 0.4, 0.8}};
  const Plane<float> phase = centred_phase(spectrum);
  Rgba8Image out(phase.width(), phase.height());
  std::ranges::transform(phase.values(), out.values().begin(), [](float angle) {
    const double turns = static_cast<double>(angle) / (2 * std::numbers::pi);
    const double place = (turns - std::floor(turns)) * 4, part = place - std::floor(place);
    const auto i = static_cast<std::size_t>(place) % 4;
    const Color &a = ring[i], &b = ring[(i + 1) % 4];
    const auto mix = [&](double p, double q) { return code8(p + part * (q - p)); };
    return Rgba8{mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), 255};
  });
  return out;
}

Rgba8Image magnitude_panel(const Spectrum& spectrum, const MagnitudeScale& scale) {
  const Plane<float> levels = levels_of(spectrum, scale);
  const int2 size = panel_size(levels.width(), levels.height());
  return fitted(metrics::paint_magma(size.x < levels.width() ? max_in(levels, size) : levels));
}

Rgba8Image phase_panel(const Spectrum& spectrum) {
  const Rgba8Image whole = paint_phase(spectrum);
  const int2 size = panel_size(whole.width(), whole.height());
  if (size.x >= whole.width()) return fitted(whole);
  Rgba8Image middle(size.x, size.y);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      middle(x, y) = whole(whole.width() / 2 - size.x / 2 + x, whole.height() / 2 - size.y / 2 + y);
  return middle;
}

int2 panel_size(int width, int height) {
  const int side = greater_side(width, height);
  if (side <= panel_px) return {width * (panel_px / side), height * (panel_px / side)};
  const auto scaled = [&](int n) {
    return std::max(1, static_cast<int>(std::floor(static_cast<double>(n) * panel_px / side + 0.5)));
  };
  return {scaled(width), scaled(height)};
}

Rgba8Image fitted(const Rgba8Image& picture) {
  const int2 size = panel_size(picture.width(), picture.height());
  if (size.x >= picture.width()) return enlarged(picture, size.x / std::max(1, picture.width()));
  DisplayImage codes(picture.width(), picture.height());
  std::ranges::transform(picture.values(), codes.values().begin(), [](Rgba8 c) {
    const auto unit = [](std::uint8_t v) { return static_cast<float>(v) / 255; };
    return Display{unit(c.r), unit(c.g), unit(c.b), unit(c.a)};
  });
  return shown(resample(metrics::make_picture(std::move(codes)).linear, size.x, size.y, make_kernel("mitchell")),
               false);
}

std::string title_of(const std::string& input) {
  if (is_pattern(input)) return input;
  return input == "-" ? "stdin" : printable(std::filesystem::path(input).filename().string());
}

}  // namespace zoneplate
