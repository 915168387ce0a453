// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/mat.h"

namespace zoneplate::upscale {

/// One frame for SGSR 2: an image of fewer pixels than the output, jittered, with its depth and motion.
///
/// Clip space is that of Vulkan: x to the right and y downwards in [-1, 1], depth in [0, 1] from near to far.
struct Sgsr2Frame {
  LinearImage color;                ///< scene-linear; alpha is not used
  Plane<float> depth;               ///< in clip space; 1 where there is no surface
  Plane<float> motion_x, motion_y;  ///< position in clip space now minus the last one; NaN at points at rest
  float4x4 last_clip_from_clip;     ///< of points at rest; the identity if the camera rests too
  float2 jitter;                    ///< the frame's pixels are sampled at their centres minus this
  float half_width = 1;             ///< tangent of half the horizontal angle of view
  bool is_first = true;             ///< after a cut: the history is dropped
  bool is_camera_at_rest = true;
};

/// Snapdragon Game Super Resolution 2: accumulates jittered frames in an image of more pixels, in two passes.
///
/// Exact     the same bits for any number of threads and any instruction set.
/// Source    Qualcomm, snapdragon-gsr, sgsr/v2, glsl_2_pass_cs, with an exposure of 1, in 32-bit floats; the values
///           that change from frame to frame, and clamping at the edges, as in Qualcomm's sample.
class Sgsr2 {
 public:
  static constexpr int phases = 32;  ///< the length of the sequence of jitters

  Sgsr2(int width, int height) : width_(width), height_(height) {}

  /// The output after one more frame: scene-linear, opaque, of the size given to the constructor.
  ///
  /// Requires  frames of one size, at most the output's, until the next one that is first. The image takes `memory` if
  ///           that has its size.
  LinearImage accumulate(const Sgsr2Frame& frame, LinearImage memory = {});

  /// Of the last frame: motion, depth clip, and the greatest channel plus 1.
  const Plane<float4>& motion_clip() const { return motion_clip_; }

 private:
  void convert(const Sgsr2Frame& frame);

  int width_, height_;
  Plane<float4> motion_clip_, ycocg_;
  Plane<float4> history_, next_history_;
  int frames_at_rest_ = 0;  ///< of the camera
};

}  // namespace zoneplate::upscale
