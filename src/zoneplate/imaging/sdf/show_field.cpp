// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/show_field.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/image/transfer.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

struct LinearColor {
  double r, g, b;
};
LinearColor mix(const LinearColor& from, const LinearColor& to, double t) {
  return {from.r + (to.r - from.r) * t, from.g + (to.g - from.g) * t, from.b + (to.b - from.b) * t};
}

// Blue and vermilion of Okabe's and Ito's palette in linear light, and light tints of them.
constexpr LinearColor white{1, 1, 1}, black{0.005, 0.005, 0.005};
constexpr LinearColor inner{0.0, 0.168, 0.445}, outer{0.665, 0.112, 0.0};

/// The coverage of a line of this width around distance 0, for a distance in pixels.
double line(double pixels, double width) { return std::clamp(width / 2 + 0.5 - std::abs(pixels), 0.0, 1.0); }

LinearColor color_of(double d, double slope, FieldView view, double spacing, double scale) {
  const LinearColor& side = d < 0 ? inner : outer;
  const double pixels = scale / std::max(slope, 0.25);
  const double to_isoline = d - spacing * std::floor(d / spacing + 0.5);
  if (view == FieldView::Isolines) {
    const LinearColor lines = mix(white, side, line(to_isoline * pixels, 1.5));
    return mix(lines, black, line(d * pixels, 4));
  }
  // Saturation rises over some ten lines; waves between the lines show the direction of the slope.
  const double far = 1 - natural_exp(-std::abs(d) / (6 * spacing));
  const double wave = 0.5 + 0.5 * cos_pi(2 * d / spacing);
  const LinearColor tint = mix(mix(white, side, 0.25), side, far);
  const LinearColor lined = mix(mix(tint, white, 0.12 * wave), black, 0.35 * line(to_isoline * pixels, 1));
  return mix(lined, white, line(d * pixels, 3));
}

}  // namespace

Rgba8Image show_field(const sdf::DistanceField& field, FieldView view, double spacing, double scale) {
  Rgba8Image out(field.distance.width(), field.distance.height());
  const auto linear_code = [](double v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0, 1.0) * 255 + 0.5); };
  metrics::for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) {
      const double gx = static_cast<double>(field.gradient_x(x, y)), gy = static_cast<double>(field.gradient_y(x, y));
      if (view == FieldView::Gradient) {
        out(x, y) = {linear_code(0.5 + 0.5 * gx), linear_code(0.5 + 0.5 * gy), 128, 255};
        continue;
      }
      const LinearColor c =
          color_of(static_cast<double>(field.distance(x, y)), std::sqrt(gx * gx + gy * gy), view, spacing, scale);
      const auto code = [](double v) { return encode_srgb8(static_cast<float>(v)); };
      out(x, y) = {code(c.r), code(c.g), code(c.b), 255};
    }
  });
  return out;
}

Rgba8Image black_on_white(const Plane<float>& coverage) {
  Rgba8Image out(coverage.width(), coverage.height());
  std::ranges::transform(coverage.values(), out.values().begin(), [](float c) {
    const std::uint8_t code = encode_srgb8(1 - c);
    return Rgba8{code, code, code, 255};
  });
  return out;
}

}  // namespace zoneplate
