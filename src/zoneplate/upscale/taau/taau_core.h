// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate::upscale {

/// One frame for TAAU: an image of fewer pixels than the output, jittered, with its depth and motion.
struct TaauInput {
  LinearImage color;                ///< scene-linear
  Plane<float> nearness;            ///< reversed depth
  Plane<float> motion_x, motion_y;  ///< in pixels of this frame: position now minus the last one, without jitter
  float2 jitter;                    ///< the frame's pixels are sampled at their centres minus this
  bool is_first = true;             ///< after a cut: the history is dropped
};

/// Temporal antialiasing that upsamples as in Unreal Engine 4: jittered samples are accumulated at the output's
/// resolution, each with a weight by its distance from the output pixel's centre.
///
/// Exact     the same bits for any number of threads and any instruction set; one colour stays that colour.
class Taau {
 public:
  /// The frames after which a still image has settled, in periods of the jitter: the first frame's share is then 6 %.
  static constexpr int settling_periods = 8;
  static constexpr int grain = 1;

  Taau(int width, int height) : width_(width), height_(height) {}

  /// The output after one more frame: scene-linear, of the size given to the constructor. Valid until the next frame.
  ///
  /// Requires  frames of one size, at most the output's, until the next one that is first.
  const LinearImage& accumulate(const TaauInput& frame);

 private:
  int width_, height_;
  LinearImage history_, next_history_, limited_;
};

}  // namespace zoneplate::upscale
