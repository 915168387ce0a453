#pragma once

#include <cstdint>

#include "zoneplate/image/plane.h"

namespace zoneplate {

/// A colour in linear light: Rec.709 primaries, 1 = diffuse white, unbounded; alpha premultiplied.
struct Linear {
  float r = 0, g = 0, b = 0, a = 1;
  bool operator==(const Linear&) const = default;
};

/// A colour as sRGB code in [0, 1] (after tone mapping); alpha straight.
struct Display {
  float r = 0, g = 0, b = 0, a = 1;
  bool operator==(const Display&) const = default;
};

/// A colour as 8-bit sRGB code; alpha straight.
struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Rgba8&) const = default;
};

/// A colour as 16-bit code; alpha straight.
struct Rgba16 {
  std::uint16_t r = 0, g = 0, b = 0, a = 65535;
  bool operator==(const Rgba16&) const = default;
};

using LinearImage = Plane<Linear>;
using DisplayImage = Plane<Display>;
using Rgba8Image = Plane<Rgba8>;
using Rgba16Image = Plane<Rgba16>;

constexpr Linear operator+(Linear a, Linear b) { return {a.r + b.r, a.g + b.g, a.b + b.b, a.a + b.a}; }
constexpr Linear operator*(Linear a, float s) { return {a.r * s, a.g * s, a.b * s, a.a * s}; }

}  // namespace zoneplate
