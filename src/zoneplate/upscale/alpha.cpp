// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/alpha.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "zoneplate/antialias/post/color_range.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::upscale {
namespace {

/// Calls use(neighbour) for the 3 × 3 pixels around a pixel that lie in the image, by row.
template <class Use>
void for_each_around(const DisplayImage& image, int x, int y, const Use& use) {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, image.height() - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, image.width() - 1); ++u) use(image(u, v));
}

/// The mean colour of 3 × 3 pixels, weighted by their alpha, with alpha 1; {0, 0, 0, 0} if all are transparent.
///
/// Sums are of differences from one of the colours, so that equal colours have that mean, exactly.
Display mean_around(const DisplayImage& image, int x, int y) {
  Display first{0, 0, 0, 0}, sum = first;
  for_each_around(image, x, y, [&](const Display& c) {
    if (!(c.a > 0)) return;
    if (sum.a == 0) first = c;
    sum.r += c.a * (c.r - first.r), sum.g += c.a * (c.g - first.g), sum.b += c.a * (c.b - first.b), sum.a += c.a;
  });
  if (!(sum.a > 0)) return {0, 0, 0, 0};
  return {first.r + sum.r / sum.a, first.g + sum.g / sum.a, first.b + sum.b / sum.a, 1};
}

/// The image of value(x, y).
template <class Value>
DisplayImage image_of(int width, int height, const Value& value) {
  DisplayImage out(width, height);
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) out(x, y) = value(x, y);
  });
  return out;
}

/// Opaque colours: each pixel's own as far as it is opaque, else those around it; step by step into the transparent
/// part, black beyond.
DisplayImage continued_colors(const DisplayImage& image) {
  const int width = image.width(), height = image.height();
  DisplayImage out = image_of(width, height, [&](int x, int y) -> Display {
    const Display c = image(x, y);
    if (c.a == 1) return c;
    const Display mean = mean_around(image, x, y);
    if (!(c.a > 0)) return mean;
    const float rest = 1 - c.a;
    return {c.r + rest * (mean.r - c.r), c.g + rest * (mean.g - c.g), c.b + rest * (mean.b - c.b), 1};
  });
  for (int step = 1; step < continued_radius; ++step)
    out = image_of(width, height, [&](int x, int y) { return out(x, y).a > 0 ? out(x, y) : mean_around(out, x, y); });
  for (Display& c : out.values()) c.a = 1;
  return out;
}

}  // namespace

void keep_visible_colors(DisplayImage& upscaled, const DisplayImage& image, const UpscaleGrid& grid, int radius) {
  const Crop made = grid.made();
  // Output pixel i of n is ((2 i + 1) m / n - 1) / 2 among the m pixels of the input: the pixel at or before it.
  const auto before = [](std::int64_t i, std::int64_t n, std::int64_t m) {
    const std::int64_t twice = (2 * i + 1) * m - n;
    return static_cast<int>(twice >= 0 ? twice / (2 * n) : -1);
  };
  parallel_for(static_cast<std::size_t>(upscaled.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row), v = before(made.y + y, grid.to.height, grid.height) - grid.y;
    for (int x = 0; x < upscaled.width(); ++x) {
      Display& c = upscaled(x, y);
      if (!(c.a > 0 && c.a < 1)) continue;
      const int u = before(made.x + x, grid.to.width, grid.width) - grid.x;
      antialias::ColorRange range;
      for (int r = 1; r <= radius && range.empty(); ++r)
        for (int j = v + 1 - r; j <= v + r; ++j)
          for (int i = u + 1 - r; i <= u + r; ++i)
            range.add(image(std::clamp(i, 0, image.width() - 1), std::clamp(j, 0, image.height() - 1)));
      c = range.clamp(c);
    }
  });
}

DisplayImage filter_with_alpha(const DisplayImage& image, const UpscaleGrid& grid,
                               const std::function<DisplayImage(const DisplayImage&)>& filter, float Display::*alpha) {
  if (std::ranges::all_of(image.values(), [](const Display& c) { return c.a == 1; })) return filter(image);
  DisplayImage alphas = image;
  for (Display& c : alphas.values()) c = {c.a, c.a, c.a, c.a};
  alphas = filter(alphas);
  DisplayImage out = filter(continued_colors(image));
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    Display& c = out.values()[i];
    c.a = alphas.values()[i].*alpha;
    if (!(c.a > 0)) c = {0, 0, 0, 0};
  }
  keep_visible_colors(out, image, grid, continued_radius);
  return out;
}

}  // namespace zoneplate::upscale
