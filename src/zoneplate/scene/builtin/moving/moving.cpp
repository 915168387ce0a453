// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/builtin/moving/moving.h"

#include "zoneplate/math/random.h"

namespace zoneplate {

Mesh make_squares(float side, float z) {
  Mesh mesh;
  const int half = static_cast<int>(2.5f / side);
  for (int j = -half; j < half; ++j)
    for (int i = -half; i < half; ++i) {
      const auto random = [&](std::uint32_t which) {
        return unit_float(hash(static_cast<std::uint32_t>(i + 1000), static_cast<std::uint32_t>(j + 1000), which));
      };
      const float3 color{0.05f + 0.75f * random(1), 0.05f + 0.75f * random(2), 0.05f + 0.75f * random(3)};
      const float x = side * static_cast<float>(i), y = side * static_cast<float>(j);
      add_quad(mesh, {{x, y, z}, {x + side, y, z}, {x + side, y + side, z}, {x, y + side, z}}, color, color);
    }
  return mesh;
}

}  // namespace zoneplate
