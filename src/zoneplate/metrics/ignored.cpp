// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/ignored.h"

#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {

void mark_ignored(Picture& reference, const IgnoredRegions& regions) {
  if (regions.empty()) return;
  const int width = reference.width(), height = reference.height();
  Plane<std::uint8_t> out(width, height);
  for (const IgnoredRegions::Rectangle& r : regions.rectangles) {
    const auto end = [](int begin, int size, int most) { return begin > most - size ? most : begin + size; };
    const int right = end(r.x, r.width, width), bottom = end(r.y, r.height, height);
    for (int y = r.y; y < bottom; ++y)
      for (int x = r.x; x < right; ++x) out(x, y) = 1;
  }
  for (const auto& [name, mask] : regions.masks) {
    if (mask.width() != width || mask.height() != height)
      throw Error(ErrorKind::Input, fmt::format("{}: the mask has {} × {} pixels, the reference {} × {}", name,
                                                mask.width(), mask.height(), width, height));
    const Plane<double> light = luma_plane(mask.display);
    for (std::size_t i = 0; i < out.values().size(); ++i)
      if (light.values()[i] > 0.5) out.values()[i] = 1;
  }
  if (std::ranges::none_of(out.values(), [](std::uint8_t v) { return v == 0; }))
    throw Error(ErrorKind::Input, "all pixels are ignored: none remains to measure");
  reference.is_ignored = std::move(out);
}

void hide_ignored(Picture& reference, Picture& test) {
  if (reference.is_ignored.empty() || reference.width() != test.width() || reference.height() != test.height()) return;
  for_rows(reference.height(), [&](int y) {
    for (int x = 0; x < reference.width(); ++x) {
      if (is_measured(reference, x, y)) continue;
      test.display(x, y) = reference.display(x, y);
      test.linear(x, y) = reference.linear(x, y);
      if (!reference.is_uncovered.empty()) reference.is_uncovered(x, y) = 0;
    }
  });
}

double measured_pixels(const Picture& reference) {
  const auto all = static_cast<double>(reference.display.values().size());
  return reference.is_ignored.empty()
             ? all
             : all - static_cast<double>(std::ranges::count(reference.is_ignored.values(), std::uint8_t{1}));
}

}  // namespace zoneplate::metrics
