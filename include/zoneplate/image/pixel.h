// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#pragma GCC visibility push(default)
namespace zoneplate {

/// A colour in linear light: Rec.709 primaries, 1 = diffuse white, unbounded; alpha premultiplied.
struct Linear {
  float r = 0, g = 0, b = 0, a = 1;  ///< the colours are already multiplied by alpha; opaque black by default
  bool operator==(const Linear&) const = default;
};

/// A display-referred colour, sRGB-encoded, in [0, 1]; straight alpha.
struct Display {
  float r = 0, g = 0, b = 0, a = 1;  ///< opaque black by default
  bool operator==(const Display&) const = default;
};

/// A colour in 8-bit sRGB-encoded values; straight alpha.
struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;  ///< 0 to 255; opaque black by default
  bool operator==(const Rgba8&) const = default;
};

/// A colour in 16-bit encoded values; straight alpha.
struct Rgba16 {
  std::uint16_t r = 0, g = 0, b = 0, a = 65535;  ///< 0 to 65535; opaque black by default
  bool operator==(const Rgba16&) const = default;
};

/// Eight neighbouring pixels of a row, channel by channel, as vectors hold them.
struct alignas(64) Linear8 {
  static constexpr int size = 8;  ///< pixels
  float r[8], g[8], b[8], a[8];   ///< one channel of the eight pixels, left to right

  /// Pixel i, counted from the left.
  Linear get(std::size_t i) const { return {r[i], g[i], b[i], a[i]}; }
  /// Replaces pixel i, counted from the left.
  void set(std::size_t i, const Linear& c) { r[i] = c.r, g[i] = c.g, b[i] = c.b, a[i] = c.a; }
  bool operator==(const Linear8&) const = default;
};

///@{
/// Arithmetic of premultiplied colours for weighted sums of samples: alpha is treated as the other channels are.
constexpr Linear operator+(Linear a, Linear b) { return {a.r + b.r, a.g + b.g, a.b + b.b, a.a + b.a}; }
constexpr Linear operator*(Linear a, float s) { return {a.r * s, a.g * s, a.b * s, a.a * s}; }
///@}

}  // namespace zoneplate
#pragma GCC visibility pop
