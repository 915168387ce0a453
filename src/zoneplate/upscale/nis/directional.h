// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The constants of NIS that follow from its sharpness, for display-referred images of standard range.
struct NisConstants {
  /// `sharpness` is in [0, 1].
  explicit NisConstants(float sharpness);

  float detect_ratio, detect_threshold;  ///< of a gradient over the one across it; minimum gradient
  float min_contrast, contrast_scale;    ///< the ratio of contrasts where sharpening begins to fade, 1 / range
  float first_luma, luma_scale;          ///< the luma where sharpening begins to fade, 1 / range
  float strength, strength_scale;        ///< of sharpening: for light areas, and what dark ones have in addition
  float limit, limit_scale;              ///< of the change, relative to luma, likewise
};

/// The filters by phase: 64 rows of eight floats, of which six are taps.
struct NisTaps {
  const float *scale, *sharpening;
};
inline constexpr int nis_phases = 64;

/// The input of one output row of the scaler. Rows of lumas begin `nis_border` pixels before the input, rows of edges
/// one pixel.
struct NisRow {
  const float* lumas[6];            ///< of rows y - 2 to y + 3, where y is the row above the output's centre
  const float* columns;             ///< filtered along columns: sum of the six rows, by the phase of y
  const float* edges[2];            ///< of rows y and y + 1, four weights per pixel
  const float* pixels[2];           ///< of rows y and y + 1
  const std::int32_t* luma;         ///< index of column x - 2 in the rows of lumas
  const std::int32_t* edge;         ///< index of column x in the rows of edges, in floats
  const std::int32_t* pixel[2];     ///< index of columns x and x + 1, clamped, in floats
  const float* right;               ///< distance of the output's centre from column x, in [0, 1)
  const std::int32_t* right_phase;  ///< the same in 64ths, rounded down
  float below;                      ///< the distance from row y
  std::int32_t below_phase;
};
inline constexpr int nis_border = 3;

/// The operations of NVIDIA Image Scaling.
///
/// Exact     the same bits on every instruction set.
/// Source    NVIDIA Image Scaling SDK 1.0.3, NIS_Scaler.h: NVScaler and NVSharpen.
struct NisKernels : PerIsa<NisKernels> {
  /// The Rec. 709 luma of n pixels.
  void (*luma_row)(const float* pixels, float* luma, std::size_t n);
  /// The weights of four directions at n pixels: of an edge along the rows, along the columns, and along the two
  /// diagonals; all 0 where there is no edge. Lumas are valid from one before the first to one after the last.
  void (*edge_row)(const float* above, const float* here, const float* below, const NisConstants& constants,
                   float* edges, std::size_t n);
  /// Sums of six rows with the taps of one phase.
  void (*column_row)(const float* const* rows, const float* taps, float* out, std::size_t n);
  /// One row of n output pixels.
  void (*scale_row)(const NisRow& row, const NisTaps& taps, const NisConstants& constants, float* out, std::size_t n);
  /// n pixels of the input's size, from five rows of lumas and one of edges.
  void (*sharpen_row)(const float* const* lumas, const float* edges, const float* pixels, const NisConstants& constants,
                      float* out, std::size_t n);
};

}  // namespace zoneplate
