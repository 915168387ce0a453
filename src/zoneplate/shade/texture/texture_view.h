// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/image/half.h"

namespace zoneplate {

/// The texels between the beginnings of two rows of a level: its width and a border of one texel on each side. Rows
/// whose lengths are large multiples of 256 are padded, by the lines of a cache that a block of 64 texels takes: else
/// all rows would begin in the same few sets of the first-level cache, which hold some 100 of its 512 lines.
struct RowPitch {
  static constexpr std::int32_t border = 2, padding = 46, min_padded = 512, multiple = 256;
  static constexpr std::int32_t of(std::int32_t width) {
    return width + border + (width >= min_padded && width % multiple == 0 ? padding : 0);
  }
};

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
  float most = 1;                          ///< the greatest red, green or blue
  std::int32_t levels = 0;                 ///< of the mip pyramid; level 0 is the largest
  std::int32_t width[max_levels] = {}, height[max_levels] = {};  ///< of each level, without its border
  std::int32_t offset[max_levels] = {};                          ///< where each level begins, in texels

  /// Texels from one row to the next.
  std::int32_t pitch(int level) const { return RowPitch::of(width[level]); }
  /// The number of texel (x, y) of a level; x in [-1, width], y in [-1, height].
  std::int32_t texel(int level, std::int32_t x, std::int32_t y) const {
    return offset[level] + (y + 1) * pitch(level) + x + 1;
  }
};

/// A ripmap: the image reduced k times along u and l times along v, for all k and l.
///
/// Shape     texel (x, y) of level (k, l) has the index offset[max_levels l + k] + (y + 1) RowPitch::of(width[k]) + x + 1, with
///           a border as in TextureView.
/// Source    Larson and Shah, Method for generating addresses to textured graphics primitives stored in RIP maps, US
///           patent 5222205, 1990.
struct RipmapView {
  TextureView texels;                  ///< its pointers, and the pyramid from which the ripmap was made
  std::int32_t columns = 0, rows = 0;  ///< numbers of levels along u, and along v
  std::int32_t width[TextureView::max_levels] = {}, height[TextureView::max_levels] = {};  ///< by level along an axis
  std::int32_t offset[TextureView::max_levels * TextureView::max_levels] = {};
};

/// A summed-area table: entry (x, y) is the sum of the texels of level 0 in the first x columns and the first y rows.
///
/// Shape     (width + 1) × (height + 1) entries of four channels, row by row; exactly one pointer is set.
/// Source    Crow, Summed-Area Tables for Texture Mapping, SIGGRAPH 1984.
struct SumsView {
  const std::uint64_t* codes = nullptr;  ///< of unorm8 or unorm15 texels
  const double* values = nullptr;        ///< of floats or half floats
  float unit = 1;                        ///< the value of a code
  std::int32_t width = 0, height = 0;
};

}  // namespace zoneplate
