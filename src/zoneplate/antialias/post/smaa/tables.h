// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace zoneplate::antialias {

/// The two areas of a revectorised edge: in the pixel below (or right of) the border and in the one above (or left of)
/// it.
struct AreaPair {
  double below = 0, above = 0;
};

/// The edges that cross the two ends of an edge, as bits of a pattern in [0, 16).
enum : int { left_down = 1, right_down = 2, left_up = 4, right_up = 8 };

/// The areas in a pixel of an axis-parallel edge, `left` pixels from its left end and `right` from its right one.
///
/// Edges     `offset` is the position of the sample across the edge, in pixels; `is_smooth` rounds short U shapes, as
///           SMAA does and MLAA does not.
/// Exact     the operations of the reference generator in its order.
AreaPair orthogonal_area(int pattern, int left, int right, double offset, bool is_smooth);

/// The areas at a diagonal edge whose sample is displaced by `offset_x`, `offset_y`.
///
/// Exact     fractions of a grid of 30 × 30 points, as in the reference generator.
AreaPair diagonal_area(int pattern, int left, int right, double offset_x, double offset_y);

/// The lines of a diagonal pattern, by the codes of the edges that cross its ends: 1 the left edge, 2 the top one, 3
/// both.
///
/// Shape     bits 0 to 3: x and y of a line's first point, and of its last one relative to the diagonal's length; bits 4
///           to 7: the same of another line, whose areas are averaged with the first one's.
std::int32_t diagonal_lines_of(int left_code, int right_code);

/// The rounding of areas to 8 bits.
enum class AreaRounding {
  Down,     ///< as in SMAA's own table
  Nearest,  ///< as in other generators of it
};

/// The part of SMAA's area texture for one position of the samples.
///
/// Shape     80 × 80 cells of two codes each, rows from the top; orthogonal cells are indexed by 16 × code + √distance,
///           diagonal ones by 20 × code + distance.
struct AreaSlot {
  static constexpr int size = 80;
  std::array<std::uint8_t, 2 * size * size> orthogonal{}, diagonal{};
};

/// Slots 0 to 6; the diagonal part of 5 and 6 is empty. A table is computed at its first use, and kept.
///
/// Source    Jimenez et al., SMAA, v2.8, AreaTex.
const AreaSlot& area_slot(int slot, AreaRounding rounding = AreaRounding::Down);

/// SMAA's search texture: 127 times the number of the last two fetched pixels that belong to the line of a search.
///
/// Shape     64 × 16, indexed by the fetched values in 1/32: x by the crossing edges (first the left search's half,
///           then the right one's), y by the edges along the line, from 32 downwards.
std::vector<std::uint8_t> make_search_table();

}  // namespace zoneplate::antialias
