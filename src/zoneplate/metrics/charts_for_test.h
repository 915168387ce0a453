// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The four pairs of 256 × 128 images on which published implementations of FLIP, SSIM and PSNR were run.
/// Their values are linear light for FLIP and codes for the others.
struct ChartPair {
  LinearImage reference, test;
};

/// An image whose pixels are `color_at(x, y)`, a Linear.
template <class ColorAt>
LinearImage make_chart(int width, int height, const ColorAt& color_at) {
  LinearImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image(x, y) = color_at(x, y);
  }
  return image;
}

inline Linear grey(double value) {
  const float v = static_cast<float>(value);
  return {v, v, v, 1};
}

/// Pair 0: a sharp and a soft edge; 1: a zone plate and its mean; 2: a colour gradient and the same with more red; 3: a
/// checkerboard and the same shifted by a pixel.
inline ChartPair chart_pair(int which) {
  const auto chart = [](const auto& color_at) { return make_chart(256, 128, color_at); };
  const auto cx = [](int x) { return x - 127.5; };
  const auto cy = [](int y) { return y - 63.5; };
  if (which == 0) {
    const auto side = [=](int x, int y) { return 0.8660254 * cx(x) + 0.5 * cy(y); };
    return {chart([=](int x, int y) { return grey(side(x, y) > 0 ? 0.8 : 0.05); }),
            chart([=](int x, int y) { return grey(0.05 + 0.75 * std::clamp(side(x, y) / 3 + 0.5, 0.0, 1.0)); })};
  }
  if (which == 1) {
    const auto zone = [=](int x, int y) {
      return 0.5 + 0.5 * std::cos(3.14159265358979323846 * (cx(x) * cx(x) + cy(y) * cy(y)) / 512);
    };
    return {chart([=](int x, int y) { return grey(zone(x, y)); }), chart([](int, int) { return grey(0.5); })};
  }
  if (which == 2) {
    const auto red = [](int x) { return static_cast<float>(x) / 255; };
    const auto green = [](int y) { return static_cast<float>(y) / 127; };
    return {chart([=](int x, int y) {
              return Linear{red(x), green(y), 0.25f, 1};
            }),
            chart([=](int x, int y) {
              return Linear{std::min(1.0f, red(x) + 0.1f), green(y), 0.25f, 1};
            })};
  }
  const auto board = [](int x, int y) { return grey((x / 8 + y / 8) % 2 == 0 ? 0.6 : 0.2); };
  return {chart(board), chart([=](int x, int y) { return board(x + 1, y); })};
}

/// Maps values v to 8 v², for the metrics of unbounded light.
inline LinearImage brightened(LinearImage image) {
  for (Linear& c : image.values()) c = {8 * c.r * c.r, 8 * c.g * c.g, 8 * c.b * c.b, 1};
  return image;
}

/// The values as display codes, without conversion from linear light.
inline DisplayImage as_codes(const LinearImage& image) {
  DisplayImage codes(image.width(), image.height());
  std::ranges::transform(image.values(), codes.values().begin(), [](const Linear& c) {
    return Display{c.r, c.g, c.b, c.a};
  });
  return codes;
}

}  // namespace zoneplate::metrics
