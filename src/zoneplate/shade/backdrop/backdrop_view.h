// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

/// The images of what is behind transmissive surfaces, which they refract, with their blurred levels, in the form that
/// kernels read.
///
/// Shape     scene-linear RGBA, premultiplied, rows from the top, one level after the other, one image after the other.
///           A texel of level k covers 2^k × 2^k pixels of the image.
struct BackdropView {
  static constexpr int max_levels = 16;
  const float* texels = nullptr;
  std::int32_t levels = 0;  ///< at least 1
  std::int32_t width[max_levels] = {}, height[max_levels] = {};
  std::int32_t offset[max_levels] = {};  ///< where each level begins, in texels of an image
  /// Where the image begins that an instance refracts, in texels, by instance; null: all refract the first.
  const std::int32_t* first_texel = nullptr;
  float clip_from_world[16] = {};  ///< by columns
};

}  // namespace zoneplate
