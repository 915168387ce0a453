// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/backdrop.h"

#include <algorithm>

#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

Display blended(Display c, float rest) { return {c.r * c.a + rest, c.g * c.a + rest, c.b * c.a + rest, 1}; }

Display encoded(Linear c) {
  const auto code = [](float v) { return encode_srgb(std::clamp(v, 0.0f, 1.0f)); };
  return {code(c.r), code(c.g), code(c.b), 1};
}

}  // namespace

bool has_alpha(const Picture& picture) {
  return std::ranges::any_of(picture.linear.values(), [](const Linear& c) { return c.a != 1; });
}

Picture finite(Picture picture) {
  if (!std::ranges::all_of(picture.linear.values(), is_finite))
    for (Linear& c : picture.linear.values()) c = finite(c);
  return picture;
}

Picture laid_on(Picture picture, Backdrop backdrop) {
  if (backdrop == Backdrop::Black && !picture.is_scene_linear) return picture;  // codes_on_black does it
  for_rows(picture.height(), [&](int y) {
    for (int x = 0; x < picture.width(); ++x) {
      Linear& light = picture.linear(x, y);
      Display& codes = picture.display(x, y);
      const float rest = backdrop == Backdrop::White ? 1 - std::clamp(light.a, 0.0f, 1.0f) : 0.0f;
      light = {light.r + rest, light.g + rest, light.b + rest, 1};
      codes = picture.is_scene_linear ? encoded(light) : blended(codes, rest);
    }
  });
  return picture;
}

}  // namespace zoneplate::metrics
