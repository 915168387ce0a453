// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/mat.h"
#include "zoneplate/shade/backdrop/backdrop_view.h"

namespace zoneplate {

/// Images with blurred levels of half the size each, which transmissive surfaces refract.
class Backdrop {
 public:
  /// One image for all instances. A level is the one before, filtered by the binomial weights 1 3 3 1 along both axes.
  ///
  /// Requires  the image is scene-linear, premultiplied and not empty.
  /// Errors    OutOfMemory.
  Backdrop(const LinearImage& image, const float4x4& clip_from_world);

  /// Adds an image for some of the scene's instances.
  ///
  /// Requires  the image has the size of the first; all images together have fewer than 2^31 texels.
  /// Errors    OutOfMemory.
  void add(const LinearImage& image, std::span<const std::uint32_t> instances, std::size_t instances_of_scene);

  /// Valid as long as the backdrop, until an image is added.
  BackdropView view() const;

  /// The texels of one image with its levels.
  std::int64_t texels_per_image() const { return texels_per_image_; }

 private:
  void append(const LinearImage& image);

  BackdropView view_;
  std::int64_t texels_per_image_ = 0;
  std::vector<float> texels_;
  std::vector<std::int32_t> first_texel_;  ///< by instance; empty: the first image for all
};

}  // namespace zoneplate
