// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The inner loop of all spatial filters: weighted sums of rows.
///
/// `narrow`: out[i] = (…(w[0] rows[0][first + i] + w[1] rows[1][first + i]) + …) in float, for i in [0, n).
/// `wide`: the same with products and sums in double, rounded to float once; if the weights sum to 1, a constant is
/// preserved to the bit.
///
/// A filter along rows passes the same row shifted by one element per tap; one along columns passes consecutive rows.
/// Requires  taps >= 1; `out` overlaps no row.
/// Exact     elements are independent, products and sums separate and in the order of the taps: the same bits on every
///           instruction set.
struct RowSumKernels : PerIsa<RowSumKernels> {
  void (*narrow)(const float* const* rows, std::size_t first, const float* weights, std::size_t taps, float* out,
                 std::size_t n);
  void (*wide)(const float* const* rows, std::size_t first, const double* weights, std::size_t taps, float* out,
               std::size_t n);
};

}  // namespace zoneplate
