// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/method.h"

#include <algorithm>
#include <cmath>

namespace zoneplate {

ImageExtent frame_size(const ImageExtent& image, double scale) {
  constexpr double rounding = 1e-9;  // more than that of a quotient of at most 32768
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::floor(n / scale + rounding))); };
  return {side(image.width), side(image.height), std::nullopt};
}

std::unique_ptr<Resolver> make_resolver(std::span<const Method> catalogue, std::string_view text) {
  const auto [method, settings] = parse_spec("method", catalogue, text);
  return method.make(settings);
}

}  // namespace zoneplate
