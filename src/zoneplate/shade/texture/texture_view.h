// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/image/half.h"

namespace zoneplate {

/// A texture in the form that kernels read: plain data, valid as long as the Texture.
///
/// Shape     texel (x, y) of level l has the index offset[l] + (y + 1) pitch(l) + x + 1, four channels each. A level has
///           a border of one texel, which repeats the opposite side: the right neighbour of a texel always follows it,
///           and the texel below lies a pitch further on. Two texels after the last one may be read.
/// Range     levels are `max_size` texels wide and high at most; values are finite, colours in [0, 1e9], alpha and data
///           in [0, 1]. Half floats are at most 65504.
struct TextureView {
  static constexpr int max_levels = 16;    ///< enough for `max_size`
  static constexpr int max_size = 32768;   ///< texels along a side
  const std::uint8_t* unorm8 = nullptr;    ///< a value is unorm8 / 255; exactly one of the four pointers is set
  const std::uint16_t* unorm15 = nullptr;  ///< a value is unorm15 / 32767
  const Half* halves = nullptr;            ///< half floats
  const float* values = nullptr;           ///< floats
  std::int32_t levels = 0;                 ///< of the mip pyramid; level 0 is the largest
  std::int32_t width[max_levels] = {}, height[max_levels] = {};  ///< of each level, without its border
  std::int32_t offset[max_levels] = {};                          ///< where each level begins, in texels

  /// Texels from one row to the next, border included.
  std::int32_t pitch(int level) const { return width[level] + 2; }
  /// The number of texel (x, y) of a level; x in [-1, width], y in [-1, height].
  std::int32_t texel(int level, std::int32_t x, std::int32_t y) const {
    return offset[level] + (y + 1) * pitch(level) + x + 1;
  }
};

}  // namespace zoneplate
