// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/fsr/passes.h"

namespace zoneplate::upscale {

struct Fsr2Options {
  bool sharpens = false;
  float sharpness = 0;              ///< in [0, 1]
  bool locks = true;                ///< thin features keep their history; for measurements of what that contributes
  bool rectifies = true;            ///< history is clamped to the colours of the frame's neighbourhood; likewise
  bool clips_depth = true;          ///< disoccluded pixels drop their history; likewise
  bool has_lanczos = true;          ///< Lanczos' kernels, not bilinear history and a bell; likewise
  float exposure = 0;               ///< factor of the colours; 0: from the frame's mean luminance
  float frame_seconds = 1.0f / 60;  ///< time between frames, to which the automatic exposure adapts
};

/// What the passes of one frame make, for tests.
struct Fsr2Passes {
  float exposure = 1;
  Plane<float> luminance;  ///< logarithms, for blocks of 32 × 32 pixels
  fsr::Dilated dilated;
  Plane<float> previous_depth;  ///< where the frame's surfaces were in the last frame
  Plane<float> lock_luma;
  DisplayImage prepared;      ///< Y, Co, Cg of the exposed colours, and in place of alpha the depth clip
  Plane<float> accumulation;  ///< mask of divergent motion, with which history counts less
  Plane<float> new_locks;     ///< of the output's size: 1 where a thin feature begins
};

/// FidelityFX Super Resolution 2.2: accumulates jittered frames in an image of more pixels.
///
/// Exact     the same bits for any number of threads and any instruction set.
/// Source    AMD, FidelityFX-FSR2 2.2.1, src/ffx-fsr2-api/shaders, in 32-bit floats, with Lanczos kernels by definition
///           for history and approximated for the frame, without reactive masks.
class Fsr2 {
 public:
  Fsr2(int width, int height, const Fsr2Options& options) : width_(width), height_(height), options_(options) {}

  /// The output after one more frame: scene-linear, opaque, of the size given to the constructor.
  ///
  /// Requires  frames of one size, at most the output's, until the next one that is first. The image takes `memory` if
  ///           that has its size.
  LinearImage accumulate(const FsrFrame& frame, LinearImage memory = {});

  /// The intermediate results of the last frame.
  const Fsr2Passes& passes() const { return passes_; }

 private:
  void rectify_and_blend(const FsrFrame& frame);

  int width_, height_;
  Fsr2Options options_;
  Fsr2Passes passes_;
  float log_luminance_ = 0;  ///< to which the exposure has adapted

  // Of the last frame. History has the colour, and the reactivity in place of alpha, negative in motion.
  LinearImage history_, next_history_;
  DisplayImage lumas_, next_lumas_;          ///< the lumas of four frames
  Plane<float> lock_life_, next_lock_life_;  ///< how much of a lock's life is left
  Plane<float> lock_luma_, next_lock_luma_;  ///< the shading when it began
  Plane<float2> last_motion_;                ///< dilated
};

}  // namespace zoneplate::upscale
