// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/height_normals.h"

#include "zoneplate/base/parallel.h"
#include "zoneplate/shade/texture/wrap_border.h"

namespace zoneplate {
Plane<float3> normals_of(const Plane<float>& heights, const HeightNormals& options) {
  constexpr std::size_t rows_per_range = 32;
  const int w = heights.width(), h = heights.height();
  const Border across = border_of(options.wrap_u), down = border_of(options.wrap_v);
  const float side =
      options.stencil == GradientStencil::Sobel ? 0.25f : 0.0f;  // weight of the rows next to the texel's
  Plane<float3> normals(w, h);
  parallel_ranges(static_cast<std::size_t>(h), rows_per_range, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < w; ++x) {
        const auto at = [&](int i, int j) {
          return heights(border_index(x + i, w, across), border_index(y + j, h, down));
        };
        // Central differences times 2, of rows and of columns.
        const auto row = [&](int j) { return at(1, j) - at(-1, j); };
        const auto column = [&](int i) { return at(i, 1) - at(i, -1); };
        const float middle = 1 - 2 * side;
        const float right = row(0) * middle + (row(-1) + row(1)) * side;
        const float below = column(0) * middle + (column(-1) + column(1)) * side;
        const float scale = options.strength * 0.5f;
        normals(x, y) = normalize(float3{-right * scale, below * scale, 1}, {0, 0, 1});
      }
  });
  return normals;
}

}  // namespace zoneplate
