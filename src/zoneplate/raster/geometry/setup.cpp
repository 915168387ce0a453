// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/setup.h"

#include <algorithm>

namespace zoneplate {

std::int64_t doubled_area(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
  return static_cast<std::int64_t>(q.x - p.x) * (r.y - p.y) - static_cast<std::int64_t>(q.y - p.y) * (r.x - p.x);
}

Triangle make_triangle(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, std::int32_t id,
                       Viewport viewport, const RasterRules& rules) {
  // The vertices are ordered clockwise on the screen, so that inside is positive.
  const std::int64_t area = doubled_area(p, q, r);
  const ScreenVertex& second = area < 0 ? r : q;
  const ScreenVertex& third = area < 0 ? q : r;
  const std::int32_t centre_x = viewport.width * 128, centre_y = viewport.height * 128;
  const std::int32_t x[3] = {p.x + centre_x, second.x + centre_x, third.x + centre_x};
  const std::int32_t y[3] = {p.y + centre_y, second.y + centre_y, third.y + centre_y};

  Triangle t;
  const auto set_edge = [&](int k, int from, int to) {
    const std::int32_t dx = x[to] - x[from], dy = y[to] - y[from];
    const bool owns_edge = (dy < 0) | ((dy == 0) & (dx > 0)) | (rules.edge_rule == EdgeRule::Inside);
    t.a[k] = -dy;
    t.b[k] = dx;
    t.c[k] = static_cast<std::int64_t>(dy) * x[from] - static_cast<std::int64_t>(dx) * y[from] - !owns_edge;
  };
  set_edge(0, 1, 2);
  set_edge(1, 2, 0);
  set_edge(2, 0, 1);

  // Samples lie at offsets 0 to 255 from the pixel's corner, so the bounds in pixels are those of the bounds' ends.
  t.min_x = std::min({x[0], x[1], x[2]}) >> 8;
  t.max_x = std::max({x[0], x[1], x[2]}) >> 8;
  t.min_y = std::min({y[0], y[1], y[2]}) >> 8;
  t.max_y = std::max({y[0], y[1], y[2]}) >> 8;

  const double z0 = p.z, dz1 = second.z - z0, dz2 = third.z - z0;
  const double dx1 = x[1] - x[0], dy1 = y[1] - y[0], dx2 = x[2] - x[0], dy2 = y[2] - y[0];
  const double inverse_area = 1.0 / static_cast<double>(area < 0 ? -area : area);
  t.x0 = x[0];
  t.y0 = y[0];
  t.z0 = z0;
  t.dzdx = (dz1 * dy2 - dz2 * dy1) * inverse_area;
  t.dzdy = (dz2 * dx1 - dz1 * dx2) * inverse_area;
  t.z_low = std::min({p.z, second.z, third.z});
  t.z_high = std::max({p.z, second.z, third.z});
  t.id = id;
  if (rules.visibility == Visibility::Painter) {
    const double mean = (z0 + static_cast<double>(second.z) + static_cast<double>(third.z)) / 3;
    t.z0 = mean;
    t.dzdx = t.dzdy = 0;
    t.z_low = t.z_high = static_cast<float>(mean);
  }
  return t;
}

void make_tile_triangle(const Triangle& t, const SamplePosition* samples, int sample_count, int tile_x, int tile_y,
                        TileTriangle& out) {
  out.first_x = std::max(t.min_x - tile_x, 0);
  out.first_y = std::max(t.min_y - tile_y, 0);
  out.last_x = std::min(t.max_x - tile_x, 63);
  out.last_y = std::min(t.max_y - tile_y, 63);
  for (int k = 0; k < 3; ++k) {
    out.a[k] = t.a[k];
    out.b[k] = t.b[k];
    const std::int64_t corner =
        t.c[k] + static_cast<std::int64_t>(t.a[k]) * tile_x * 256 + static_cast<std::int64_t>(t.b[k]) * tile_y * 256;
    for (int s = 0; s < sample_count; ++s) {
      const std::int64_t c =
          corner + static_cast<std::int64_t>(t.a[k]) * samples[s].x + static_cast<std::int64_t>(t.b[k]) * samples[s].y;
      out.c[k][s] =
          static_cast<std::int32_t>(std::clamp(c >> 8, -(std::int64_t{1} << 30), (std::int64_t{1} << 30) - 1));
    }
  }
  for (int s = 0; s < sample_count; ++s) {
    const double dx = t.min_x * 256 + samples[s].x - t.x0, dy = t.min_y * 256 + samples[s].y - t.y0;
    out.z[s] = static_cast<float>((t.z0 + t.dzdx * dx) + t.dzdy * dy);
  }
  out.dzdx = static_cast<float>(t.dzdx * 256);
  out.dzdy = static_cast<float>(t.dzdy * 256);
  out.z_low = t.z_low;
  out.z_high = t.z_high;
  out.origin_x = t.min_x - tile_x;
  out.origin_y = t.min_y - tile_y;
  out.id = t.id;
}

}  // namespace zoneplate
