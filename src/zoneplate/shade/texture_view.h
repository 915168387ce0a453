#pragma once

#include <cstdint>

namespace zoneplate {

/// How kernels see a texture: plain data, valid as long as the Texture.
///
/// Shape     texel (x, y) of level l is number offset[l] + y width[l] + x, four channels each.
struct TextureView {
  static constexpr int max_levels = 30;
  const std::uint8_t* codes8 = nullptr;    ///< a value is code / 255; exactly one of the two is there
  const std::uint16_t* codes16 = nullptr;  ///< a value is code / 65535
  std::int32_t levels = 0;
  std::int32_t width[max_levels] = {}, height[max_levels] = {}, offset[max_levels] = {};
};

}  // namespace zoneplate
