// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/fsr/passes.h"

namespace zoneplate::upscale {

struct Fsr3Options {
  bool sharpens = false;
  float sharpness = 0;              ///< in [0, 1]
  bool locks = true;                ///< thin features keep their history; for measurements of what that contributes
  bool rectifies = true;            ///< history is clamped to the colours of the frame's neighbourhood; likewise
  bool clips_depth = true;          ///< disoccluded pixels drop their history; likewise
  bool tests_shading = true;        ///< pixels whose shading changes drop their history; likewise
  float velocity_factor = 1;        ///< in [0, 1]: how much less history counts in motion
  float exposure = 0;               ///< factor of the colours; 0: from the frame's mean luminance
  float frame_seconds = 1.0f / 60;  ///< time between frames, to which the automatic exposure adapts
};

/// What the passes of one frame make, for tests.
struct Fsr3Passes {
  float exposure = 1;
  fsr::Dilated dilated;
  Plane<float> previous_depth;  ///< where the frame's surfaces were in the last frame
  Plane<float> luma;
  Plane<float> farthest_depth;  ///< the mean of 2 × 2 pixels
  Plane<float> differences;     ///< of the lumas around a pixel from those in the last frame
  Plane<float> shading_change;  ///< for blocks of 2 × 2 pixels, from three levels of the differences
  DisplayImage masks;           ///< divergence of motion, disocclusion, change of shading, share of the history
  Plane<float> new_locks;       ///< of the output's size: the contrast of a thin feature
  Plane<float> instability;     ///< where luma alternates
};

/// The upscaler of FidelityFX Super Resolution 3.1: accumulates jittered frames in an image of more pixels.
///
/// Exact     the same bits for any number of threads and any instruction set.
/// Source    AMD, FidelityFX SDK 1.1.4, sdk/include/FidelityFX/gpu/fsr3upscaler (version 3.1.4), with its textures of 8
///           bits, 32-bit floats in place of those of 16, Lanczos kernels by definition for history and approximated
///           for the frame, without reactive masks.
class Fsr3 {
 public:
  Fsr3(int width, int height, const Fsr3Options& options) : width_(width), height_(height), options_(options) {}

  /// The output after one more frame: scene-linear, opaque, of the size given to the constructor.
  ///
  /// Requires  frames of one size, at most the output's, until the next one that is first. The image takes `memory` if
  ///           that has its size.
  LinearImage accumulate(const FsrFrame& frame, LinearImage memory = {});

  /// The intermediate results of the last frame.
  const Fsr3Passes& passes() const { return passes_; }

 private:
  void forget(int frame_width, int frame_height);
  void prepare(const FsrFrame& frame);
  void upsample(const FsrFrame& frame);

  int width_, height_;
  Fsr3Options options_;
  Fsr3Passes passes_;
  bool is_first_ = true;

  // Of the last frame.
  float log_luminance_ = 0;  ///< to which the exposure has adapted
  float2 last_jitter_;
  LinearImage history_, next_history_;  ///< the lock in place of alpha
  Plane<float> last_luma_;
  Plane<float> accumulation_, next_accumulation_;  ///< how much history a pixel has
  DisplayImage luma_history_, next_luma_history_;  ///< the lumas of four frames
};

}  // namespace zoneplate::upscale
