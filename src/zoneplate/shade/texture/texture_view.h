#pragma once

#include <cstdint>

namespace zoneplate {

/// A texture in the form that kernels read: plain data, valid as long as the Texture.
///
/// Shape     texel (x, y) of level l has the index offset[l] + (y + 1) pitch(l) + x + 1, four channels each. A level has
///           a border of one texel, which repeats the opposite side: the right neighbour of a texel always follows it,
///           and the texel below lies a pitch further on. Two texels after the last one may be read.
/// Range     levels are `max_size` texels wide and high at most; values are finite, colours in [0, 1e9], alpha and data
///           in [0, 1].
struct TextureView {
  static constexpr int max_levels = 16;
  static constexpr int max_size = 32768;
  const std::uint8_t* unorm8 = nullptr;    ///< a value is unorm8 / 255; exactly one of the three pointers is set
  const std::uint16_t* unorm15 = nullptr;  ///< a value is unorm15 / 32767
  const float* values = nullptr;           ///< the values themselves
  std::int32_t levels = 0;
  std::int32_t width[max_levels] = {}, height[max_levels] = {}, offset[max_levels] = {};

  std::int32_t pitch(int level) const { return width[level] + 2; }
  std::int32_t texel(int level, std::int32_t x, std::int32_t y) const {
    return offset[level] + (y + 1) * pitch(level) + x + 1;
  }
};

}  // namespace zoneplate
