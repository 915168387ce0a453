// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

#include "zoneplate/upscale/fsr/frame.h"

/// Frames with which the tests of FSR 2 and FSR 3 are made.
namespace zoneplate::upscale {

inline constexpr int frame_width = 48, frame_height = 36;
using Pattern = std::function<float(float x, float y)>;  // of positions in widths of the image

/// A frame of grey light at the jittered positions, on a plane at depth 5, that moves by `motion` frame pixels a frame.
inline FsrFrame frame_of(const Pattern& light, int index, int phases, float2 motion = {0, 0}) {
  FsrFrame frame{.color = LinearImage(frame_width, frame_height),
                 .depth = Plane<float>(frame_width, frame_height, 5.0f),
                 .motion = Plane<float2>(frame_width, frame_height, motion),
                 .jitter = fsr_jitter(index, phases),
                 .corner = 1.2f,
                 .is_first = index == 0};
  for (int y = 0; y < frame_height; ++y)
    for (int x = 0; x < frame_width; ++x) {
      const auto n = static_cast<float>(index);
      const float px = static_cast<float>(x) + 0.5f - frame.jitter.x - n * motion.x;
      const float py = static_cast<float>(y) + 0.5f - frame.jitter.y - n * motion.y;
      const float v = light(px / frame_width, py / frame_width);
      frame.color(x, y) = {v, v, v, 1};
    }
  return frame;
}

inline float edge(float x, float y) { return x * 2 + y > 1.4f ? 0.9f : 0.1f; }

/// The root mean square difference from the mean of 8 × 8 points in each pixel, away from the sides.
inline double error_of(const LinearImage& image, const Pattern& light) {
  double sum = 0;
  int count = 0;
  for (int y = 6; y < image.height() - 6; ++y)
    for (int x = 6; x < image.width() - 6; ++x) {
      double mean = 0;
      for (int k = 0; k < 64; ++k) {
        const auto at = [&](int i, int s) {
          return (static_cast<float>(i) + (static_cast<float>(s) + 0.5f) / 8) / static_cast<float>(image.width());
        };
        mean += double{light(at(x, k % 8), at(y, k / 8))} / 64;
      }
      const double off = double{image(x, y).g} - mean;
      sum += off * off, ++count;
    }
  return std::sqrt(sum / count);
}

/// A frame of small squares that move to the left by a pixel per frame, in whole numbers.
inline FsrFrame squares(int index, int phases) {
  constexpr int width = 96, height = 64;
  constexpr float aspect = 1.5f, tan_half_fov = 0.5f;
  FsrFrame frame{.color = LinearImage(width, height),
                 .depth = Plane<float>(width, height),
                 .motion = Plane<float2>(width, height, {index > 0 ? -1.0f : 0.0f, 0}),
                 .jitter = fsr_jitter(index, phases),
                 .corner = std::sqrt(1 + tan_half_fov * tan_half_fov * (1 + aspect * aspect)),
                 .is_first = index == 0};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int moved = x + index;
      const float v = static_cast<float>((moved * 7 + y * 13 + moved / 5 * (y / 3) * 3) % 16) / 16 * 0.75f + 0.05f;
      frame.color(x, y) = {v, 0.5f * v + 0.1f, (moved + y) % 8 == 0 ? 1.75f : 0.25f, 1};
      frame.depth(x, y) = 5 + static_cast<float>(y) * 0.25f;
    }
  return frame;
}

}  // namespace zoneplate::upscale
