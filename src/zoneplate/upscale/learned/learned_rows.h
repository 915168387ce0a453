// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/taau/sample_mean_rows.h"

namespace zoneplate {

/// A history of an output row's pixels.
struct HistoryRow {
  float *color, *count;      ///< four floats per pixel, and the number of samples
  float *inside, *filtered;  ///< 1 where it is within the image, and where it lies between pixels; else 0
};

/// What `learned` knows of an output row's pixels before the network.
struct GatheredRow {
  float* current;   ///< the mean of the frame's samples: four floats per pixel
  HistoryRow near;  ///< by the motion that is followed
  HistoryRow own;   ///< by that of the nearest sample's surface, where the other one is borrowed; else undefined
};

/// One row of a frame, for LearnedKernels::describe.
struct FeatureRow {
  const float *color, *low, *high;  ///< four floats per pixel
  const float *alike, *borrowed, *steady, *uncovered, *kept, *change, *trend;
  const float *follow_x, *follow_y, *nearest;
  const float *nearness, *past_unrest;  ///< of pixel (0, 0)
  const float* column;                  ///< 0, 1, 2, ...
  std::int32_t y, width, height;
  float first[2];  ///< of the first of an axis's two output pixels, from the sample, in frame pixels
  float scale[2];  ///< output pixels per frame pixel

  /// The two output rows of the frame's row, and in them the two output pixels of each of the frame's.
  GatheredRow above, below;
  const std::int32_t *left, *right;

  std::int16_t* features;  ///< out: LearnedNetwork::features numbers per pixel
  float* unrest;           ///< out: the mean over few frames of the difference of history and samples
};

/// What the network says about a part of an output row.
struct CorrectionRow {
  std::size_t begin;           ///< its first pixel
  const float* corrections;    ///< as Network::write writes them
  const std::int32_t* middle;  ///< where in them those of each output pixel begin
};

/// The passes of LearnedMean.
///
/// Exact     the same bits on every instruction set.
struct LearnedKernels : PerIsa<LearnedKernels> {
  /// `own_x` and `own_y` are the motion of the frame's row, not that which is followed.
  void (*gather)(const SampleMeanFrame& frame, const SampleMeanRow& row, const float* own_x, const float* own_y,
                 const GatheredRow& out, std::size_t n);
  void (*describe)(const FeatureRow& row, std::size_t n);
  /// n pixels from corrections.begin on.
  void (*blend)(const SampleMeanFrame& frame, const SampleMeanRow& row, const GatheredRow& known,
                const CorrectionRow& corrections, std::size_t n);
};

}  // namespace zoneplate
