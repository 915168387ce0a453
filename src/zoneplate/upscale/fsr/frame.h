// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate::upscale {

/// One frame for FSR 2 or FSR 3: an image of fewer pixels than the output, jittered, with its depth and motion.
struct FsrFrame {
  static constexpr float far = 1e7f;  ///< the depth of empty pixels

  LinearImage color;     ///< scene-linear; alpha is not used
  Plane<float> depth;    ///< distance along the view axis; at most `far`
  Plane<float2> motion;  ///< in pixels of this frame: position now minus the last one, without jitter
  float2 jitter;         ///< the frame's pixels are sampled at their centres minus this
  float corner = 1;      ///< length of the vector from the camera to the image's corner at depth 1
  bool is_first = true;  ///< after a cut: the history is dropped
};

/// The length of the sequence of jitters for a frame and an output of these widths: 8 × the squared ratio, at least 1.
int fsr_phases(int frame_width, int width);

/// Element `index` of the sequence, rounded to 1/256 pixel: in [-½, ½].
float2 fsr_jitter(int index, int phases);

}  // namespace zoneplate::upscale
