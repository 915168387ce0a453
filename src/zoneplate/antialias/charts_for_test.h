// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "zoneplate/image/hash_for_test.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"

namespace zoneplate::antialias {

template <class ColorAt>
Rgba8Image make_codes(int width, int height, const ColorAt& color_at) {
  Rgba8Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = color_at(x, y);
  return image;
}

/// The chart of 64 × 64 pixels on which other implementations of FXAA and SMAA were run.
inline Rgba8Image chart64() {
  return make_codes(64, 64, [](int i, int j) {
    const double x = i + 0.5, y = j + 0.5;
    if (i >= 6 && i < 10 && j >= 6 && j < 10) return Rgba8{255, 0, 0};
    if (std::abs(x - y - 6) < 0.75 && j > 24) return Rgba8{10, 160, 40};
    if ((x - 40) * (x - 40) + (y - 14) * (y - 14) < 64) return Rgba8{240, 240, 240};
    if (100 * x - 37 * y > 4200) return Rgba8{60, 90, 220};
    if (100 * y - 23 * x > 800) return Rgba8{220, 200, 60};
    return Rgba8{30, 30, 30};
  });
}

/// Discs and bars of random colours: edges at all angles, thin lines and corners; lumas are never nearly equal.
inline Rgba8Image random_shapes(int width, int height, std::uint32_t seed) {
  Rgba8Image image(width, height, {40, 44, 52});
  std::uint32_t n = 0;
  const auto random = [&] { return unit_float(hash(seed * 1000003u + n++)); };
  for (int shape = 0; shape < width * height / 300; ++shape) {
    const float cx = random() * static_cast<float>(width), cy = random() * static_cast<float>(height);
    const float t = 2 * random() - 1, size = 2 + 18 * random(), thin = 0.6f + 5 * random() * random();
    const bool is_disc = random() < 0.4f;
    const auto code = [&] { return static_cast<std::uint8_t>(random() * 255); };
    const Rgba8 color{code(), code(), code()};
    const float ux = (1 - t * t) / (1 + t * t), uy = 2 * t / (1 + t * t);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float dx = static_cast<float>(x) + 0.5f - cx, dy = static_cast<float>(y) + 0.5f - cy;
        const float along = dx * ux + dy * uy, across = dx * uy - dy * ux;
        if (is_disc ? dx * dx + dy * dy < size * size / 4 : std::abs(along) < size && std::abs(across) < thin)
          image(x, y) = color;
      }
  }
  return image;
}

/// A white band on black along a line of slope 1 / run, point-sampled once per pixel, and its exact area in each pixel.
struct Band {
  static constexpr int width = 160, height = 56;
  double run, thickness, start = 20.1;
  double below(double x) const { return start + x / run; }
  Rgba8Image codes(double u, double v) const {
    return make_codes(width, height, [&](int x, int y) {
      const double depth = y + v - below(x + u);
      return depth > 0 && depth < thickness ? Rgba8{255, 255, 255} : Rgba8{0, 0, 0};
    });
  }
  double area(int x, int y) const {
    double sum = 0;
    for (int i = 0; i < 64; ++i) {
      const double top = below(x + (i + 0.5) / 64);
      sum += std::max(0.0, std::min(y + 1.0, top + thickness) - std::max<double>(y, top));
    }
    return sum / 64;
  }
  /// Root mean square error, in linear light, of the pixels on the band's edges, away from the sides of the image.
  double error(const Rgba8Image& image) const {
    double sum = 0;
    int count = 0;
    for (int y = 4; y < height - 4; ++y)
      for (int x = 40; x < width - 40; ++x) {
        const double off = static_cast<double>(decode_srgb8(image(x, y).g)) - area(x, y);
        if (area(x, y) > 0 && area(x, y) < 1) sum += off * off, ++count;
      }
    return std::sqrt(sum / count);
  }
};

/// FNV-1a over the colours without alpha, which some other implementations discard.
inline std::uint64_t hash_of_colors(const Rgba8Image& image) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const Rgba8& c : image.values())
    for (const std::uint8_t v : {c.r, c.g, c.b}) h = (h ^ v) * 0x100000001b3u;
  return h;
}

/// The number of pixels that differ by more than `tolerance` in any channel.
inline int count_differing(const Rgba8Image& a, const Rgba8Image& b, int tolerance) {
  int count = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const Rgba8 p = a.values()[i], q = b.values()[i];
    count += std::abs(p.r - q.r) > tolerance || std::abs(p.g - q.g) > tolerance || std::abs(p.b - q.b) > tolerance ||
             std::abs(p.a - q.a) > tolerance;
  }
  return count;
}

}  // namespace zoneplate::antialias
