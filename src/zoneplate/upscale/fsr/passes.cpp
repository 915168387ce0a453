// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr/passes.h"

#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/fsr1/rcas.h"

namespace zoneplate::upscale {

int fsr_phases(int frame_width, int width) {
  const float ratio = static_cast<float>(width) / static_cast<float>(frame_width);
  return std::max(static_cast<int>(8 * (ratio * ratio)), 1);
}

float2 fsr_jitter(int index, int phases) {
  const auto halton = [](int i, int base) {
    double f = 1, result = 0;
    for (; i > 0; i /= base) f /= base, result += f * (i % base);
    return result;
  };
  const auto rounded = [](double v) { return static_cast<float>(std::floor((v - 0.5) * 256 + 0.5) / 256); };
  const int i = index % phases + 1;
  return {rounded(halton(i, 2)), rounded(halton(i, 3))};
}

namespace fsr {

Dilated dilate(const FsrFrame& frame) {
  static constexpr int offsets[9][2] = {{0, 0}, {1, 0}, {0, 1}, {0, -1}, {-1, 0}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}};
  const int width = frame.depth.width(), height = frame.depth.height();
  Dilated out{Plane<float>(width, height), Plane<float2>(width, height)};
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      int nearest_x = x, nearest_y = y;
      for (const auto& [dx, dy] : offsets)
        if (contains(frame.depth, x + dx, y + dy) && frame.depth(x + dx, y + dy) < frame.depth(nearest_x, nearest_y))
          nearest_x = x + dx, nearest_y = y + dy;
      const float2 motion = frame.motion(nearest_x, nearest_y);
      out.depth(x, y) = std::min(frame.depth(nearest_x, nearest_y), FsrFrame::far);
      out.motion(x, y) = {-motion.x / static_cast<float>(width), -motion.y / static_cast<float>(height)};
    }
  });
  return out;
}

Plane<float> previous_depth(const Dilated& dilated, float min_weight,
                            const std::function<bool(float2 motion, float depth)>& is_motion) {
  const int width = dilated.depth.width(), height = dilated.depth.height();
  Plane<float> out(width, height, FsrFrame::far);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float depth = dilated.depth(x, y);
      float2 motion = dilated.motion(x, y);
      if (!is_motion(motion, depth)) motion = {0, 0};
      const float px = static_cast<float>(x) + motion.x * static_cast<float>(width);
      const float py = static_cast<float>(y) + motion.y * static_cast<float>(height);
      if (!(px > -2 && py > -2 && px < static_cast<float>(width + 1) && py < static_cast<float>(height + 1))) continue;
      BilinearTaps(px, py).for_each([&](int i, int j, float w) {
        if (w > min_weight && contains(out, i, j)) out(i, j) = std::min(out(i, j), depth);
      });
    }
  return out;
}

Plane<float> halved(const Plane<float>& plane) {
  Plane<float> out((plane.width() + 1) / 2, (plane.height() + 1) / 2);
  const auto value = [&](int x, int y) { return contains(plane, x, y) ? plane(x, y) : 0.0f; };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out(x, y) =
          (value(2 * x, 2 * y) + value(2 * x + 1, 2 * y) + value(2 * x, 2 * y + 1) + value(2 * x + 1, 2 * y + 1)) *
          0.25f;
  return out;
}

float automatic_exposure(float log_luminance) {
  // The luminance that saturates a sensor of ISO 100, at an exposure for the mean: S = 100, K = 12.5, q = 0.65.
  return 1 / (78.0f / (0.65f * 100) * (exp(log_luminance) * 100 / 12.5f));
}

LinearImage sharpened(const LinearImage& image, float exposure, float sharpness, float most) {
  const int width = image.width(), height = image.height();
  LinearImage exposed(width + 2, height + 2), out(width, height);
  for_rows(height + 2, [&](int y) {
    for (int x = 0; x < width + 2; ++x) {
      const Linear& c = at_clamped(image, x - 1, y - 1);
      const auto value = [&](float v) { return std::clamp(v * exposure, 0.0f, most); };
      exposed(x, y) = {value(c.r), value(c.g), value(c.b), 1};
    }
  });
  const RcasOptions rcas{
      .sharpness = exp2(2 * sharpness - 2), .limits_by_ring = true, .is_unbounded = true, .denoises = true};
  for_rows(height, [&](int y) {
    const auto row = [&](int i) { return &exposed.row(y + i)[1].r; };
    RcasKernels::of().sharpen_row(row(0), row(1), row(2), rcas, &out.row(y).data()->r, static_cast<std::size_t>(width));
    for (Linear& c : out.row(y)) c = {c.r / exposure, c.g / exposure, c.b / exposure, 1};
  });
  return out;
}

LinearImage opaque(const LinearImage& image) {
  LinearImage out(image.width(), image.height());
  for_rows(image.height(), [&](int y) {
    std::ranges::transform(image.row(y), out.row(y).begin(), [](const Linear& c) { return Linear{c.r, c.g, c.b, 1}; });
  });
  return out;
}

}  // namespace fsr
}  // namespace zoneplate::upscale
