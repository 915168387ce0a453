// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

#include "zoneplate/signal/samples.h"
#include "zoneplate/upscale/taau/taau_core.h"

namespace zoneplate::upscale {

/// Frames of a plane, for tests of TAAU at scale 2.
namespace taau_frames {

inline constexpr int width = 40, height = 30, scale = 2;
/// The light at a point of the image, in frame pixels, in a frame.
using LightAt = std::function<double(double x, double y, int frame)>;

inline SamplePosition sample_at(int index) {
  static const SamplePattern halton = halton_sequence(32);
  return halton[static_cast<std::size_t>(index) % halton.size()];
}

/// A frame of a plane that moves by `motion` frame pixels a frame; its light is given where it was at first.
inline TaauInput frame_of(const LightAt& light, int index, float2 motion = {0, 0}) {
  const SamplePosition at = sample_at(index);
  TaauInput frame{.color = LinearImage(width, height),
                  .nearness = Plane<float>(width, height, 0.5f),
                  .motion_x = Plane<float>(width, height, motion.x),
                  .motion_y = Plane<float>(width, height, motion.y),
                  .jitter = {(128 - at.x) / 256.0f, (128 - at.y) / 256.0f},
                  .is_first = index == 0};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto v = static_cast<float>(
          light(x + at.x / 256.0 - index * double{motion.x}, y + at.y / 256.0 - index * double{motion.y}, index));
      frame.color(x, y) = {v, 0.5f * v, 0.25f * v, 1};
    }
  return frame;
}

/// The image of Taau or SampleMean after some frames.
template <class Core>
LinearImage after(int frames, const LightAt& light, float2 motion = {0, 0}) {
  Core core(scale * width, scale * height);
  LinearImage image;
  for (int i = 0; i < frames; ++i) image = core.accumulate(frame_of(light, i, motion));
  return image;
}

/// The squared error of square roots of `after`(frames, light, motion) against the light's mean over each output pixel,
/// without a border of 8 pixels.
template <class Core>
double error_after(int frames, const LightAt& light, float2 motion = {0, 0}) {
  const LinearImage image = after<Core>(frames, light, motion);
  const int last = frames - 1;
  double sum = 0;
  for (int y = 8; y < scale * height - 8; ++y)
    for (int x = 8; x < scale * width - 8; ++x) {
      double expected = 0;
      for (int k = 0; k < 64; ++k)
        expected += light((x + (k % 8 + 0.5) / 8) / scale - last * double{motion.x},
                          (y + (k / 8 + 0.5) / 8) / scale - last * double{motion.y}, last) /
                    64;
      sum += std::pow(std::sqrt(double{image(x, y).r}) - std::sqrt(expected), 2);
    }
  return sum;
}

}  // namespace taau_frames
}  // namespace zoneplate::upscale
