// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/channel_image.h"

#include <algorithm>
#include <cstddef>

#include "zoneplate/base/deadline.h"

namespace zoneplate {
namespace {

float red_of(Rgba8 p) { return static_cast<float>(p.r) / 255; }
float red_of(Rgba16 p) { return static_cast<float>(p.r) / 65535; }
float red_of(float4 p) { return p.x > 0 ? std::min(p.x, 1.0f) : 0.0f; }

void set(Rgba8& p, int channel, float value) {
  const auto code = static_cast<std::uint8_t>(value * 255 + 0.5f);
  (channel == 1 ? p.g : p.b) = code;
}
void set(float4& p, int channel, float value) { (channel == 1 ? p.y : p.z) = value; }

/// Sets a channel of every texel to the red of the texel of `from` in the same place.
template <class Texel>
void copy_red(const TexelImage& from, int channel, Plane<Texel>& to) {
  from.visit([&](const auto& texels) {
    const auto scaled = [](int i, int size, int of) { return static_cast<int>(std::int64_t{i} * of / size); };
    for (int y = 0; y < to.height(); ++y) {
      check_deadline();
      const auto row = texels.row(scaled(y, to.height(), texels.height()));
      for (int x = 0; x < to.width(); ++x)
        set(to(x, y), channel, red_of(row[static_cast<std::size_t>(scaled(x, to.width(), texels.width()))]));
    }
  });
}

bool has_codes8(const TexelImage* image) { return image == nullptr || image->kind() == TexelKind::Codes8; }

template <class Texel>
TexelImage joined(const TexelImage* roughness, const TexelImage* metallic, Texel white) {
  const TexelImage& sized = roughness != nullptr ? *roughness : *metallic;
  Plane<Texel> out(sized.width(), sized.height(), white);
  if (roughness != nullptr) copy_red(*roughness, 1, out);
  if (metallic != nullptr) copy_red(*metallic, 2, out);
  return out;
}

}  // namespace

std::uint64_t with_metallic_roughness_memory(const TexelImage* roughness, const TexelImage* metallic) {
  const TexelImage& sized = roughness != nullptr ? *roughness : *metallic;
  const std::uint64_t texel = has_codes8(roughness) && has_codes8(metallic) ? sizeof(Rgba8) : sizeof(float4);
  return static_cast<std::uint64_t>(sized.width()) * static_cast<std::uint64_t>(sized.height()) * texel;
}

TexelImage with_metallic_roughness(const TexelImage* roughness, const TexelImage* metallic) {
  if (has_codes8(roughness) && has_codes8(metallic)) return joined(roughness, metallic, Rgba8{255, 255, 255, 255});
  return joined(roughness, metallic, float4{1, 1, 1, 1});
}

}  // namespace zoneplate
