// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/fsr/frame.h"

/// The passes of FSR 2 and FSR 3 over a frame, as far as both have them.
namespace zoneplate::upscale::fsr {

/// Calls body(y) for every row, in parallel.
inline constexpr std::size_t rows_a_block = 16;
template <class Body>
void for_rows(int height, const Body& body) {
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) body(y);
  });
}

inline float saturated(float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; }
inline float luma709(const Linear& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

template <class T>
T at_clamped(const Plane<T>& plane, int x, int y) {
  return plane(std::clamp(x, 0, plane.width() - 1), std::clamp(y, 0, plane.height() - 1));
}
template <class T>
bool contains(const Plane<T>& plane, int x, int y) {
  return x >= 0 && y >= 0 && x < plane.width() && y < plane.height();
}

/// The four pixels around a position, in pixels from the centre of the first one, with their weights.
struct BilinearTaps {
  int x, y;
  float weight[4];

  BilinearTaps(float px, float py)
      : x(static_cast<int>(std::floor(px))), y(static_cast<int>(std::floor(py))), weight() {
    const float right = px - std::floor(px), below = py - std::floor(py);
    weight[0] = (1 - right) * (1 - below), weight[1] = right * (1 - below);
    weight[2] = (1 - right) * below, weight[3] = right * below;
  }
  template <class Use>
  void for_each(const Use& use) const {
    for (int k = 0; k < 4; ++k) use(x + k % 2, y + k / 2, weight[k]);
  }
};

/// The nearest depth of 3 × 3 pixels and the motion there.
struct Dilated {
  Plane<float> depth;
  Plane<float2> motion;  ///< to the last frame, in widths and heights of the image
};
void dilate(const FsrFrame& frame, Dilated& out);

/// Where the frame's surfaces were in the last frame: every pixel that a surface touched with more than `min_weight`
/// gets the nearest depth. A motion at a depth moves nothing unless is_motion says so.
Plane<float> previous_depth(const Dilated& dilated, float min_weight,
                            const std::function<bool(float2 motion, float depth)>& is_motion);

/// Means of 2 × 2 elements; beyond the plane there are zeros.
Plane<float> halved(const Plane<float>& plane);

/// The exposure for a mean of the logarithm of the luminance.
float automatic_exposure(float log_luminance);

/// The image, opaque, after robust contrast-adaptive sharpening of its exposed colours, of which values above `most`
/// are clamped. The result takes `memory` if that has its size.
LinearImage sharpened(const LinearImage& image, float exposure, float sharpness, float most, LinearImage memory);

/// The image with alpha 1. The result takes `memory` if that has its size.
LinearImage opaque(const LinearImage& image, LinearImage memory);

}  // namespace zoneplate::upscale::fsr
