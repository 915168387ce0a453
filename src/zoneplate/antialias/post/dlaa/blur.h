// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The constants of the method, as published.
struct DlaaConstants {
  static constexpr float lambda = 3, epsilon = 0.1f;
  static constexpr int half_blur = 8;                ///< pixels of the long blur, to either side
  static constexpr int whole = 255 * 2 * half_blur;  ///< of sixteen codes
  static constexpr float least_unlike = 0.2f;        ///< how unlike the two directions must be for the long blur
  static constexpr int unseen_bend = 51;             ///< up to which lambda × half its luma - epsilon is not positive
};

/// What the last pass of a row reads: its pixels' codes, around which eight pixels more are valid on every side; their
/// edge codes; the sums of seventeen of those along the row and down the columns.
struct DlaaRows {
  const std::uint8_t* codes;
  std::ptrdiff_t stride;  ///< of the codes, in bytes
  const std::uint8_t* edges;
  const std::int16_t *level, *upright;
};

/// The operations of DLAA on all pixels of a row.
///
/// Shape     rows of colours are four codes a pixel, those of `here` valid from one pixel before the first to one after
///           the last. Sums are made in whole vectors: rows of codes are read up to 31 values after the n-th, and
///           arrays have room for n rounded up to 64.
struct DlaaKernels : PerIsa<DlaaKernels> {
  /// A third of four times the sum of |l + r + t + b - 4 c| over red, green and blue, rounded, at most 255.
  void (*edge_row)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, std::uint8_t* edges,
                   std::size_t n);
  /// The sums of the seventeen codes around each.
  void (*sum_row)(const std::uint8_t* edges, std::int16_t* sums, std::size_t n);
  /// sums += added - removed
  void (*slide_row)(const std::uint8_t* added, const std::uint8_t* removed, std::int16_t* sums, std::size_t n);
  /// 1 where the sum of |a + b - 2 c| over the colours exceeds `bend` for left and right or for above and below, or
  /// where one of the two sums exceeds `sum`; else 0.
  void (*seen_row)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                   const std::int16_t* level, const std::int16_t* upright, int bend, int sum, std::uint8_t* seen,
                   std::size_t n);
  /// Blurs the pixels that are seen; others of `out` are left alone.
  void (*blur_row)(const DlaaRows& rows, const std::uint8_t* seen, std::uint8_t* out, std::size_t n);
};

}  // namespace zoneplate
