// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr/passes.h"

#include <span>
#include <utility>
#include <vector>

#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/fsr1/rcas.h"
#include "zoneplate/upscale/scatter_rows.h"

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

void dilate(const FsrFrame& frame, Dilated& out) {
  static constexpr int offsets[9][2] = {{0, 0}, {1, 0}, {0, 1}, {0, -1}, {-1, 0}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}};
  const int width = frame.depth.width(), height = frame.depth.height();
  out.depth.fit(width, height), out.motion.fit(width, height);
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
}

Plane<float> previous_depth(const Dilated& dilated, float min_weight,
                            const std::function<bool(float2 motion, float depth)>& is_motion) {
  const int width = dilated.depth.width(), height = dilated.depth.height();
  auto out = Plane<float>::unset(width, height);
  // Where each pixel was.
  auto position = Plane<float2>::unset(width, height);
  std::vector<RowRange> rows(static_cast<std::size_t>(height));
  for_rows(height, [&](int y) {
    RowRange& own = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < width; ++x) {
      float2 motion = dilated.motion(x, y);
      if (!is_motion(motion, dilated.depth(x, y))) motion = {0, 0};
      const float px = static_cast<float>(x) + motion.x * static_cast<float>(width);
      const float py = static_cast<float>(y) + motion.y * static_cast<float>(height);
      const bool is_near_image =
          px > -2 && py > -2 && px < static_cast<float>(width + 1) && py < static_cast<float>(height + 1);
      position(x, y) = is_near_image ? float2{px, py} : float2{-3, -3};
      if (!is_near_image) continue;
      const int above = static_cast<int>(std::floor(py));
      own.add(above), own.add(above + 1);
    }
  });
  const auto begin = [&](int first, int after) {
    for (int y = first; y < after; ++y) std::ranges::fill(out.row(y), FsrFrame::far);
  };
  scatter_rows(rows, begin, [&](int y, int first, int after) {
    for (int x = 0; x < width; ++x) {
      const float2 at = position(x, y);
      if (!(at.x > -2)) continue;
      BilinearTaps(at.x, at.y).for_each([&](int i, int j, float w) {
        if (!(w > min_weight && j >= first && j < after && i >= 0 && i < width)) return;
        out(i, j) = std::min(out(i, j), dilated.depth(x, y));
      });
    }
  });
  return out;
}

Plane<float> halved(const Plane<float>& plane) {
  Plane<float> out((plane.width() + 1) / 2, (plane.height() + 1) / 2);
  const auto value = [&](int x, int y) { return contains(plane, x, y) ? plane(x, y) : 0.0f; };
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x)
      out(x, y) =
          (value(2 * x, 2 * y) + value(2 * x + 1, 2 * y) + value(2 * x, 2 * y + 1) + value(2 * x + 1, 2 * y + 1)) *
          0.25f;
  });
  return out;
}

float automatic_exposure(float log_luminance) {
  // The luminance that saturates a sensor of ISO 100, at an exposure for the mean: S = 100, K = 12.5, q = 0.65.
  return 1 / (78.0f / (0.65f * 100) * (exp(log_luminance) * 100 / 12.5f));
}

LinearImage sharpened(const LinearImage& image, float exposure, float sharpness, float most, LinearImage memory) {
  const int width = image.width(), height = image.height();
  LinearImage out = std::move(memory);
  out.fit(width, height);
  const RcasOptions rcas{
      .sharpness = exp2(2 * sharpness - 2), .limits_by_ring = true, .is_unbounded = true, .denoises = true};
  struct Block {
    LinearImage exposed;  // with a border of one pixel
    explicit Block(int pixels) : exposed(pixels + 2, static_cast<int>(rows_a_block) + 2) {}
  };
  PerThread<Block> blocks;
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    LinearImage& exposed = blocks.local(width).exposed;
    const int first = static_cast<int>(begin), rows = static_cast<int>(end - begin);
    for (int y = 0; y < rows + 2; ++y)
      for (int x = 0; x < width + 2; ++x) {
        const Linear& c = at_clamped(image, x - 1, first + y - 1);
        const auto value = [&](float v) { return std::clamp(v * exposure, 0.0f, most); };
        exposed(x, y) = {value(c.r), value(c.g), value(c.b), 1};
      }
    for (int y = 0; y < rows; ++y) {
      const auto row = [&](int i) { return &exposed.row(y + i)[1].r; };
      const std::span<Linear> made = out.row(first + y);
      RcasKernels::of().sharpen_row(row(0), row(1), row(2), rcas, &made.data()->r, made.size());
      for (Linear& c : made) c = {c.r / exposure, c.g / exposure, c.b / exposure, 1};
    }
  });
  return out;
}

LinearImage opaque(const LinearImage& image, LinearImage memory) {
  LinearImage out = std::move(memory);
  out.fit(image.width(), image.height());
  for_rows(image.height(), [&](int y) {
    std::ranges::transform(image.row(y), out.row(y).begin(), [](const Linear& c) { return Linear{c.r, c.g, c.b, 1}; });
  });
  return out;
}

}  // namespace fsr
}  // namespace zoneplate::upscale
