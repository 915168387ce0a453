// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/opacity_map.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "zoneplate/base/deadline.h"

namespace zoneplate {
namespace {

/// Clamps to [0, 1]; NaN gives 0.
float unit(float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; }

bool is_whole(Rgba8 p) { return p.a == 255; }
bool is_whole(Rgba16 p) { return p.a == 65535; }
bool is_whole(float4 p) { return p.w >= 1; }

float alpha_of(Rgba8 p) { return static_cast<float>(p.a) / 255; }
float alpha_of(Rgba16 p) { return static_cast<float>(p.a) / 65535; }
float alpha_of(float4 p) { return unit(p.w); }

/// The luma, quantized as the texel's type.
template <class Texel>
float luma_of(Texel p) {
  const std::uint32_t code = (p.r * 2126u + p.g * 7152u + p.b * 722u + 5000u) / 10000u;
  return static_cast<float>(code) / (sizeof(p.r) == 1 ? 255.0f : 65535.0f);
}
float luma_of(float4 p) { return unit(unit(p.x) * 0.2126f + unit(p.y) * 0.7152f + unit(p.z) * 0.0722f); }

void set_alpha(Rgba8& p, float alpha) { p.a = static_cast<std::uint8_t>(alpha * 255 + 0.5f); }
void set_alpha(Rgba16& p, float alpha) { p.a = static_cast<std::uint16_t>(alpha * 65535 + 0.5f); }
void set_alpha(float4& p, float alpha) { p.w = alpha; }

Rgba16 widened(Rgba8 p) {
  const auto wide = [](std::uint8_t code) { return static_cast<std::uint16_t>(code * 257); };
  return {wide(p.r), wide(p.g), wide(p.b), wide(p.a)};
}

/// Integer values are not converted to linear light, because their encoding is unknown.
TexelKind kind_of(const TexelImage* color, const TexelImage& map) {
  if (color == nullptr || color->kind() == TexelKind::Light) return color == nullptr ? map.kind() : color->kind();
  return map.kind() == TexelKind::Codes8 ? color->kind() : TexelKind::Codes16;
}

/// The image with each texel's alpha replaced by the opacity of the map's texel at the same position.
template <class Texel, class Map>
Plane<Texel> cut_by(Plane<Texel> image, const Plane<Map>& map) {
  const auto texels = map.values();
  const bool has_alpha = std::any_of(texels.begin(), texels.end(), [](const Map& p) { return !is_whole(p); });
  const auto scaled = [](int i, int to, int from) { return static_cast<int>(std::int64_t{i} * to / from); };
  for (int y = 0; y < image.height(); ++y) {
    check_deadline();
    const auto from = map.row(scaled(y, map.height(), image.height()));
    for (int x = 0; x < image.width(); ++x) {
      const Map& p = from[static_cast<std::size_t>(scaled(x, map.width(), image.width()))];
      set_alpha(image(x, y), has_alpha ? alpha_of(p) : luma_of(p));
    }
  }
  return image;
}

/// The image's texels in a type with at least as many bits.
template <class Texel>
Plane<Texel> widened_image(const TexelImage& image) {
  if constexpr (std::is_same_v<Texel, Rgba16>) {
    if (image.kind() == TexelKind::Codes8) {
      const Rgba8Image& codes = image.as<Rgba8>();
      Rgba16Image out(codes.width(), codes.height());
      std::transform(codes.values().begin(), codes.values().end(), out.values().begin(), widened);
      return out;
    }
  }
  return image.as<Texel>();
}

}  // namespace

std::uint64_t with_opacity_memory(const TexelImage* color, const TexelImage& map) {
  const TexelImage& sized = color != nullptr ? *color : map;
  const TexelKind kind = kind_of(color, map);
  const std::uint64_t texel = kind == TexelKind::Codes8    ? sizeof(Rgba8)
                              : kind == TexelKind::Codes16 ? sizeof(Rgba16)
                                                           : sizeof(float4);
  return static_cast<std::uint64_t>(sized.width()) * static_cast<std::uint64_t>(sized.height()) * texel;
}

TexelImage with_opacity(const TexelImage* color, const TexelImage& map) {
  const auto made = [&]<class Texel>(Texel white) -> TexelImage {
    return map.visit([&](const auto& texels) -> TexelImage {
      return cut_by(color != nullptr ? widened_image<Texel>(*color) : Plane<Texel>(map.width(), map.height(), white),
                    texels);
    });
  };
  const TexelKind kind = kind_of(color, map);
  if (kind == TexelKind::Codes8) return made(Rgba8{255, 255, 255, 255});
  if (kind == TexelKind::Codes16) return made(Rgba16{65535, 65535, 65535, 65535});
  return made(float4{1, 1, 1, 1});
}

bool is_opaque(const TexelImage& image) {
  return image.visit([](const auto& plane) {
    const auto texels = plane.values();
    return std::all_of(texels.begin(), texels.end(), [](const auto& p) { return is_whole(p); });
  });
}

}  // namespace zoneplate
