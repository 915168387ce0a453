// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The constants of the method, as published.
struct DlaaConstants {
  static constexpr float lambda = 3, epsilon = 0.1f;
  static constexpr int half_blur = 8;                ///< pixels of the long blur on either side
  static constexpr int whole = 255 * 2 * half_blur;  ///< the maximum sum of sixteen codes
  static constexpr float min_unlike = 0.2f;          ///< minimum difference of the two directions for the long blur
  /// The greatest second difference for which lambda × half its luma - epsilon is not positive.
  static constexpr int unseen_bend = 51;
};

/// The input of the last pass for a row: its pixels' codes, which are valid for eight more pixels on every side; their
/// edge codes; and the sums of seventeen edge codes along the row and along the columns.
struct DlaaRows {
  const std::uint8_t* codes;
  std::ptrdiff_t stride;  ///< of the codes, in bytes
  const std::uint8_t* edges;
  const std::int16_t *level, *upright;
};

/// The operations of DLAA on all pixels of a row.
///
/// Shape     rows of colours have four codes per pixel; `here` is valid from one pixel before the first to one after
///           the last. Sums use whole vectors: rows of codes are read up to 31 values after the n-th, and arrays have
///           capacity for n rounded up to 64.
struct DlaaKernels : PerIsa<DlaaKernels> {
  /// A third of four times the sum of |l + r + t + b - 4 c| over red, green and blue, rounded, at most 255.
  void (*edge_row)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, std::uint8_t* edges,
                   std::size_t n);
  /// For each code, the sum of the seventeen codes centred on it.
  void (*sum_row)(const std::uint8_t* edges, std::int16_t* sums, std::size_t n);
  /// sums += added - removed
  void (*slide_row)(const std::uint8_t* added, const std::uint8_t* removed, std::int16_t* sums, std::size_t n);
  /// 1 if the sum of |a + b - 2 c| over the colours exceeds `bend` for left and right or for above and below, or if
  /// either of the two sums of edge codes exceeds `sum`; else 0.
  void (*seen_row)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                   const std::int16_t* level, const std::int16_t* upright, int bend, int sum, std::uint8_t* seen,
                   std::size_t n);
  /// Blurs the pixels selected in `seen`; the other pixels of `out` are unchanged.
  void (*blur_row)(const DlaaRows& rows, const std::uint8_t* seen, std::uint8_t* out, std::size_t n);
};

}  // namespace zoneplate
