// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The products of the gradient of luma, per pixel.
struct GradientRow {
  float *xx, *xy, *yy;
};

/// One row that filters of a table make.
struct TableRow {
  const float* roots[3][5];     ///< by channel, five rows of square roots of light, two pixels before the first one
  const std::int32_t* classes;  ///< per pixel, counted through all groups
  const float* weights;         ///< of all classes
  const float* image;           ///< the light of the pixels: four floats each
  float* out;                   ///< likewise
};

/// Exact     the same bits on every instruction set.
struct TableKernels : PerIsa<TableKernels> {
  /// Square roots of the light of n pixels of four floats, and their luma.
  void (*take_roots)(const float* pixels, float* const (&roots)[3], float* luma, std::size_t n);
  /// Gradients of n pixels from three rows of luma, one pixel before the first one.
  void (*take_gradients)(const float* const (&luma)[3], const GradientRow& out, std::size_t n);
  /// Classes within a group of n pixels from five rows of gradients, two pixels before the first one.
  void (*classify)(const GradientRow (&rows)[5], std::int32_t* classes, std::size_t n);
  /// n pixels, by filters of 3 × 3 and of 5 × 5.
  void (*filter3)(const TableRow& row, std::size_t n);
  void (*filter5)(const TableRow& row, std::size_t n);
};

}  // namespace zoneplate
