// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/premultiplied.h"

#include <algorithm>

namespace zoneplate::upscale {

DisplayImage filter_premultiplied(const DisplayImage& image,
                                  const std::function<DisplayImage(const DisplayImage&)>& filter) {
  if (std::ranges::all_of(image.values(), [](const Display& c) { return c.a == 1; })) return filter(image);
  DisplayImage premultiplied = image;
  for (Display& c : premultiplied.values()) c = {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
  DisplayImage out = filter(premultiplied);
  for (Display& c : out.values()) {
    const auto straight = [&](float v) { return std::min(v, c.a) / c.a; };
    c = c.a > 0 ? Display{straight(c.r), straight(c.g), straight(c.b), c.a} : Display{0, 0, 0, 0};
  }
  return out;
}

}  // namespace zoneplate::upscale
