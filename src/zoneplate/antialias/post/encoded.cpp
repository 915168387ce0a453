// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/encoded.h"

#include <algorithm>
#include <cstdlib>

#include "zoneplate/antialias/post/color_range.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate::antialias {
namespace {

/// The background over which a transparent image is filtered.
enum class Backdrop { Black, White };

Display laid_on(const Display& c, Backdrop backdrop, Mixing mixing) {
  const float rest = backdrop == Backdrop::White ? 1 - c.a : 0.0f;
  const auto lay = [&](float code) {
    return mixing == Mixing::Encoded ? code * c.a + rest : encode_srgb(decode_srgb(code) * c.a + rest);
  };
  return {lay(c.r), lay(c.g), lay(c.b), c.a};
}

Display lifted_from(Rgba8 c, Backdrop backdrop, Mixing mixing) {
  if (c.a == 0) return {0, 0, 0, 0};
  const float a = static_cast<float>(c.a) / 255, rest = backdrop == Backdrop::White ? 1 - a : 0.0f;
  const auto lift = [&](std::uint8_t code) {
    const float v = mixing == Mixing::Encoded ? (static_cast<float>(code) / 255 - rest) / a
                                              : encode_srgb((decode_srgb8(code) - rest) / a);
    return std::clamp(v, 0.0f, 1.0f);
  };
  return {lift(c.r), lift(c.g), lift(c.b), a};
}

Display from_unorm8(Rgba8 c) {
  return {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255,
          static_cast<float>(c.a) / 255};
}

/// Calls `body(i)` for every pixel, in parallel for blocks of pixels.
template <class Body>
void for_pixels(std::size_t count, const Body& body) {
  constexpr std::size_t grain = 16384;
  parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// An image before and after a filter.
struct Filtered {
  Rgba8Image before, after;
  bool is_changed(std::size_t i) const { return before.values()[i] != after.values()[i]; }
  /// The change of a pixel's alpha.
  int alpha_change(std::size_t i) const { return std::abs(before.values()[i].a - after.values()[i].a); }
};

Filtered filter_on(const DisplayImage& image, Backdrop backdrop, Mixing mixing, const EncodedFilter& filter) {
  DisplayImage laid(image.width(), image.height());
  for_pixels(image.values().size(),
             [&](std::size_t i) { laid.values()[i] = laid_on(image.values()[i], backdrop, mixing); });
  Filtered f{quantize8(laid), {}};
  f.after = filter(f.before);
  return f;
}

/// Of the visible pixels in the smallest square around (x, y) that has any.
ColorRange colors_around(const DisplayImage& image, int x, int y) {
  constexpr int farthest = 16;  // pixels: no filter blends farther
  ColorRange range;
  for (int radius = 1; radius <= farthest && range.empty(); ++radius)
    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, image.height() - 1); ++v)
      for (int u = std::max(x - radius, 0); u <= std::min(x + radius, image.width() - 1); ++u) range.add(image(u, v));
  return range;
}

/// Silhouettes of dark objects are detected over white, those of bright objects over black: each pixel takes the result
/// in which its alpha changed more. Division by alpha enlarges the rounding of 8-bit codes: since filters blend, the
/// colour is among those around the pixel.
DisplayImage filter_transparent(const DisplayImage& image, Mixing mixing, const EncodedFilter& filter) {
  const Filtered black = filter_on(image, Backdrop::Black, mixing, filter);
  const Filtered white = filter_on(image, Backdrop::White, mixing, filter);
  DisplayImage out = image;
  const auto width = static_cast<std::size_t>(image.width());
  for_pixels(image.values().size(), [&](std::size_t i) {
    const bool is_white = white.alpha_change(i) > black.alpha_change(i);
    if (!is_white && !black.is_changed(i)) return;
    const Display found =
        lifted_from((is_white ? white : black).after.values()[i], is_white ? Backdrop::White : Backdrop::Black, mixing);
    const ColorRange range = colors_around(image, static_cast<int>(i % width), static_cast<int>(i / width));
    out.values()[i] = found.a > 0 ? range.clamp(found) : found;
  });
  return out;
}

}  // namespace

DisplayImage filter_encoded(DisplayImage image, Mixing mixing, const EncodedFilter& filter) {
  if (image.empty()) return image;
  if (std::ranges::any_of(image.values(), [](const Display& c) { return c.a < 1; }))
    return filter_transparent(image, mixing, filter);
  Filtered f{quantize8(image), {}};
  f.after = filter(f.before);
  for_pixels(image.values().size(), [&](std::size_t i) {
    if (f.is_changed(i)) image.values()[i] = from_unorm8(f.after.values()[i]);
  });
  return image;
}

Display mixed(const Display& a, const Display& b, float weight, Mixing mixing) {
  if (a == b) return a;
  const float of_a = a.a * (1 - weight), of_b = b.a * weight, alpha = of_a + of_b;
  if (!(alpha > 0)) return {0, 0, 0, 0};
  const auto channel = [&](float p, float q) {
    if (mixing == Mixing::Encoded) return (p * of_a + q * of_b) / alpha;
    return encode_srgb((decode_srgb(p) * of_a + decode_srgb(q) * of_b) / alpha);
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b), alpha};
}

Linear decode_pixel(Rgba8 codes) {
  return {decode_srgb8(codes.r), decode_srgb8(codes.g), decode_srgb8(codes.b), unorm8_value[codes.a]};
}

Rgba8 encode_pixel(Linear light) {
  return {encode_srgb8(light.r), encode_srgb8(light.g), encode_srgb8(light.b),
          round_unorm8(std::clamp(light.a, 0.0f, 1.0f) * 255)};
}

Rgba8 mix_linear(Rgba8 a, Rgba8 b, float t) {
  const Linear from = decode_pixel(a), to = decode_pixel(b);
  return encode_pixel({from.r + (to.r - from.r) * t, from.g + (to.g - from.g) * t, from.b + (to.b - from.b) * t,
                       from.a + (to.a - from.a) * t});
}

void for_rows(int height, const std::function<void(int)>& body) {
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

Rgba8Image sized_like(const Rgba8Image& like, Rgba8Image memory) {
  if (memory.width() == like.width() && memory.height() == like.height()) return memory;
  return {like.width(), like.height()};
}

}  // namespace zoneplate::antialias
