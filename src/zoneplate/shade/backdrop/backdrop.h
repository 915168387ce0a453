// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/mat.h"
#include "zoneplate/shade/backdrop/backdrop_view.h"

namespace zoneplate {

/// An image with blurred levels of half the size each, which transmissive surfaces refract.
class Backdrop {
 public:
  /// A level is the one before, filtered by the binomial weights 1 3 3 1 along both axes.
  ///
  /// Requires  the image is scene-linear, premultiplied and not empty.
  /// Errors    OutOfMemory.
  Backdrop(const LinearImage& image, const float4x4& clip_from_world);

  /// Valid as long as the backdrop.
  BackdropView view() const;

 private:
  BackdropView view_;
  std::vector<float> texels_;
};

}  // namespace zoneplate
