// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// One row of a frame, whose planes have `width` × `height` pixels, for SampleMeanKernels::survey.
struct SurveyRow {
  const float* color;                ///< of pixel (0, 0): four floats per pixel
  const float* nearness;             ///< likewise: reversed depth
  const float *motion_x, *motion_y;  ///< likewise: in frame pixels
  std::int32_t width, height;
  const float* column;  ///< 0, 1, 2, ...
  std::int32_t y;

  float *low, *high;                     ///< out: the extremes of 3 × 3 colours, four floats per pixel
  float *nearest, *follow_x, *follow_y;  ///< out: reversed depth and motion of the nearest of 3 × 3 surfaces
  float* is_alike;                       ///< out: 1 where the 3 × 3 surfaces move as one, else 0
  float* is_borrowed;  ///< out: 1 where the nearest surface moves otherwise than the pixel's own, else 0
};

/// One row of a frame with what is kept of the last one, for SampleMeanKernels::compare.
struct CompareRow {
  const float* color;                          ///< of this row: four floats per pixel
  const float *nearest, *follow_x, *follow_y;  ///< of this row, as `is_alike`
  const float* is_alike;
  const float* column;  ///< 0, 1, 2, ...
  std::int32_t y;

  /// Of pixel (0, 0) of the last frame, which has `width` × `height` pixels: the range of motions that brought surfaces
  /// of each pixel into this frame, the least and the greatest along x and y, and their greatest reversed depth; and
  /// what the last frame has left.
  const float *moved[4], *moved_nearest;
  const float *past_alike, *past_low, *past_high, *past_trend;
  std::int32_t width, height;

  const float* history;  ///< of the output's size
  std::int32_t history_width, history_height;
  float scale[2];   ///< output pixels per frame pixel
  float sample[2];  ///< where in each pixel it is sampled

  float* is_uncovered;  ///< out: 1 where a nearer surface that moves otherwise was in the last frame, else 0
  float* is_steady;     ///< out: 1 where the box of the last frame holds too, else 0
  float* change;        ///< out: 1, -1: brighter or darker than all that the last box holds; else 0
  float* trend;         ///< out: the mean over few frames of the sign of sample minus history
};

/// One row of a frame's boxes, for SampleMeanKernels::widen.
struct WidenRow {
  const float *follow_x, *follow_y, *is_steady, *is_uncovered;  ///< of this row
  const float* restarts;                                        ///< likewise: 1 where the light has changed at once
  const float* column;                                          ///< 0, 1, 2, ...
  std::int32_t y;
  const float *trend, *past_low, *past_high;  ///< of pixel (0, 0)
  std::int32_t width, height;

  float *low, *high;  ///< in and out
  float* kept;        ///< out: the part of the history's samples that counts
};

/// What all pixels of an output image have in common.
struct SampleMeanFrame {
  std::int32_t width, height;  ///< of the output
  bool is_first;               ///< there is no history
  float scale[2];              ///< output pixels per frame pixel, per axis
  float most;                  ///< the greatest number of samples that counts
  float max_filtered;          ///< the same of a history that lies between pixels, which filtering blurs
  float max_borrowed;          ///< the same of one that follows the surface beside
  const float* history;        ///< of the last frame, in the output's size: four floats per pixel
  const float* count;          ///< likewise: the sum of the weights of a pixel's samples
};

/// The input of one output row.
struct SampleMeanRow {
  const float* color[3];           ///< the three rows of the frame around it, four floats per pixel
  const std::int32_t* columns[3];  ///< pixels of the frame
  const float* weight_x[3];        ///< of the samples of these columns, for each pixel
  float weight_y[3];
  const float *low, *high, *follow_x, *follow_y, *is_borrowed, *kept;  ///< of the middle row
  const float* column;                                                 ///< 0, 1, 2, ...
  std::int32_t y;

  float *resolved = nullptr, *count = nullptr;  ///< out: four floats per pixel, and one
};

/// The passes of SampleMean.
///
/// Exact     the same bits on every instruction set. Where all colours and the history are equal, the result is that
///           colour, bit by bit.
struct SampleMeanKernels : PerIsa<SampleMeanKernels> {
  void (*survey)(const SurveyRow& row, std::size_t n);
  void (*compare)(const CompareRow& row, std::size_t n);
  void (*widen)(const WidenRow& row, std::size_t n);
  void (*resolve)(const SampleMeanFrame& frame, const SampleMeanRow& row, std::size_t n);
};

}  // namespace zoneplate
