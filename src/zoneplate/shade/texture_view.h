#pragma once

#include <cstdint>

namespace zoneplate {

/// How kernels see a texture: plain data, valid as long as the Texture.
///
/// Shape     texel (x, y) of level l is number offset[l] + y pitch(l) + x, four channels each. A row has one texel more
///           than the level is wide, a copy of its first: two neighbours always lie side by side.
struct TextureView {
  static constexpr int max_levels = 30;
  const std::uint8_t* codes8 = nullptr;    ///< a value is code / 255; exactly one of the two is there
  const std::uint16_t* codes15 = nullptr;  ///< a value is code / 32767
  std::int32_t levels = 0;
  std::int32_t width[max_levels] = {}, height[max_levels] = {}, offset[max_levels] = {};
};

}  // namespace zoneplate
