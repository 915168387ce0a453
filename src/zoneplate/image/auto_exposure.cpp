// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/auto_exposure.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace zoneplate {

float auto_exposure(const LinearImage& image) {
  constexpr float target = 0.8f, most = 0x1p100f;
  std::vector<float> brightness;
  for (const Linear& c : image.values()) {
    const float greatest = std::max({c.r, c.g, c.b});
    if (c.a >= 0.5f && greatest > 0) brightness.push_back(greatest / c.a);
  }
  if (brightness.empty()) return 1;
  const auto place = brightness.begin() + static_cast<std::ptrdiff_t>(brightness.size() * 95 / 100);
  std::nth_element(brightness.begin(), place, brightness.end());
  return std::clamp(target / *place, 1 / most, most);
}

}  // namespace zoneplate
