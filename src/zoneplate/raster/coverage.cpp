#include "zoneplate/raster/coverage.h"

namespace zoneplate::scalar {
namespace {

bool covers(const TileTriangle& t, int s, int x, int y) {
  for (int k = 0; k < 3; ++k)
    if (t.a[k] * x + t.b[k] * y + t.c[k][s] < 0) return false;
  return true;
}

bool wins(const TileTriangle& t, const TileVisibility& tile, int s, int x, int y) {
  const int at = s * tile_pixels + y * tile_size + x;
  const float z = depth_at(t, s, x, y);
  return covers(t, s, x, y) && (z > tile.depth[at] || (z == tile.depth[at] && t.id < tile.id[at]));
}

void draw(const TileTriangle& t, TileVisibility& tile) {
  for (int s = 0; s < tile.sample_count; ++s)
    for (int y = t.first_y; y <= t.last_y; ++y)
      for (int x = t.first_x; x <= t.last_x; ++x)
        if (wins(t, tile, s, x, y)) {
          tile.depth[s * tile_pixels + y * tile_size + x] = depth_at(t, s, x, y);
          tile.id[s * tile_pixels + y * tile_size + x] = t.id;
        }
}

int collect(const TileTriangle& t, const TileVisibility& tile, Fragment* out) {
  int count = 0;
  for (int y = t.first_y; y <= t.last_y; ++y)
    for (int x = t.first_x; x <= t.last_x; ++x) {
      std::uint64_t samples = 0;
      for (int s = 0; s < tile.sample_count; ++s)
        if (wins(t, tile, s, x, y)) samples |= std::uint64_t{1} << s;
      if (samples) out[count++] = {samples, static_cast<std::uint32_t>(y * tile_size + x)};
    }
  return count;
}

}  // namespace

const CoverageKernels coverage_kernels = {.draw = draw, .collect = collect};

}  // namespace zoneplate::scalar
