// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The least normal half float, as AMD writes it, and the greatest one.
inline constexpr float fsr3_epsilon = 6.1e-5f, fsr3_greatest_half = 65504;

/// Pixels of a plane between which a value is interpolated, for one row of pixels.
struct Fsr3Between {
  const float* rows[2];
  const std::int32_t* columns[2];  ///< indices in floats
  const float* right;              ///< distance from the first column, in [0, 1)
  float below;
};

/// What all rows of a frame have in common in the passes that prepare it. Planes have width × height pixels.
struct Fsr3PrepareFrame {
  std::int32_t width, height;
  float exposure;
  float jitter_x, jitter_y, last_jitter_x, last_jitter_y;  ///< in pixels
  float separation;     ///< least distance of two surfaces, as a share of their depth: closer ones are taken for one
  const float* u;       ///< the pixels' centres in [0, 1]
  const float* luma;    ///< of the colours
  const float* depth;   ///< dilated
  const float* motion;  ///< likewise: two floats per pixel, to the last frame, in widths and heights of the image
  const float* previous_depth;  ///< where the frame's surfaces were in the last frame

  // Of the last frame.
  const float* last_luma;
  const float* accumulation;  ///< how much history the pixels have: in [0, 1], in 255 steps
  const float* luma_history;  ///< four floats per pixel: the lumas of four frames, the latest first
};

/// The passes of FSR 3.1's upscaler over a frame.
///
/// Exact     the same bits on every instruction set.
/// Source    AMD, FidelityFX SDK 1.1.4: ffx_fsr3upscaler_prepare_inputs.h, _shading_change_pyramid.h,
///           _prepare_reactivity.h and _luma_instability.h.
struct Fsr3PrepareKernels : PerIsa<Fsr3PrepareKernels> {
  /// The luma of n pixels of four floats, and its logarithm, which is positive.
  void (*luma_row)(const float* colors, float* luma, float* logarithms, std::size_t n);

  /// How much the lumas around the pixels of row y differ from those in the last frame, with the sign of the change: 0
  /// if one of the former equals one of the latter.
  void (*difference_row)(const Fsr3PrepareFrame& frame, std::int32_t y, float* differences);

  /// What row y keeps of its history. `shading` is the change of shading at the pixels. `masks` receives four floats
  /// per pixel, each in 255 steps: divergence of the motion, disocclusion, change of shading, and the share of the
  /// history that counts; `accumulation` the latter for the next frame; `confidence` that a pixel is part of a thin
  /// feature.
  void (*reactivity_row)(const Fsr3PrepareFrame& frame, std::int32_t y, const Fsr3Between& shading, float* masks,
                         float* accumulation, float* confidence);

  /// Where the luma of row y alternates. `masks` and `lumas` are those at the positions of the samples; `luma_history`
  /// receives that of the next frame, `instability` a value in [0, 1].
  void (*instability_row)(const Fsr3PrepareFrame& frame, std::int32_t y, const Fsr3Between& masks,
                          const Fsr3Between& lumas, float* luma_history, float* instability);
};

}  // namespace zoneplate
