#include "zoneplate/antialias/codes.h"

#include <algorithm>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t grain = 16384;  // pixels

Display premultiplied(const Display& c, Mixing mixing) {
  const auto times = [&](float code) {
    return mixing == Mixing::Codes ? code * c.a : encode_srgb(decode_srgb(code) * c.a);
  };
  return {times(c.r), times(c.g), times(c.b), c.a};
}

Display straight(Rgba8 c, Mixing mixing) {
  if (c.a == 0) return {0, 0, 0, 0};
  const float a = static_cast<float>(c.a) / 255;
  const auto over = [&](std::uint8_t code) {
    const float v = mixing == Mixing::Codes ? static_cast<float>(code) / 255 / a : encode_srgb(decode_srgb8(code) / a);
    return std::min(v, 1.0f);
  };
  return {over(c.r), over(c.g), over(c.b), a};
}

Display shown(Rgba8 c) {
  return {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255,
          static_cast<float>(c.a) / 255};
}

}  // namespace

DisplayImage filter_codes(DisplayImage image, Mixing mixing, const CodeFilter& filter) {
  if (image.empty()) return image;
  const bool is_opaque = std::ranges::all_of(image.values(), [](const Display& c) { return c.a >= 1; });
  DisplayImage laid;
  if (!is_opaque) {
    laid = DisplayImage(image.width(), image.height());
    parallel_ranges(image.values().size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) laid.values()[i] = premultiplied(image.values()[i], mixing);
    });
  }
  const Rgba8Image before = quantize8(is_opaque ? image : laid);
  const Rgba8Image after = filter(before);
  parallel_ranges(image.values().size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Rgba8 c = after.values()[i];
      if (c != before.values()[i]) image.values()[i] = is_opaque ? shown(c) : straight(c, mixing);
    }
  });
  return image;
}

Linear light_of(Rgba8 codes) {
  return {decode_srgb8(codes.r), decode_srgb8(codes.g), decode_srgb8(codes.b), static_cast<float>(codes.a) / 255};
}

Rgba8 codes_of(Linear light) {
  return {encode_srgb8(light.r), encode_srgb8(light.g), encode_srgb8(light.b),
          rounded_code(std::clamp(light.a, 0.0f, 1.0f) * 255)};
}

Rgba8 mixed_light(Rgba8 a, Rgba8 b, float t) {
  const Linear from = light_of(a), to = light_of(b);
  return codes_of({from.r + (to.r - from.r) * t, from.g + (to.g - from.g) * t, from.b + (to.b - from.b) * t,
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
