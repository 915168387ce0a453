// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/raster/geometry/project.h"
#include "zoneplate/raster/types/raster_rules.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// A triangle ready for coverage and depth: three edge functions and a depth plane.
///
/// Edge k at a point P (1/256 pixel, from the image's top-left corner) is E_k = a_k P.x + b_k P.y + c_k, an exact
/// integer; P is inside where all three are >= 0. The fill rule is folded into c: E is lowered by one on an edge that
/// is neither top nor left, so that a point on a shared edge lies in exactly one of the two triangles.
///
/// Units     a, b per 1/256 pixel; the depth plane's gradients per pixel.
/// Source    edge functions: Pineda, A Parallel Algorithm for Polygon Rasterization, SIGGRAPH 1988; int32 half-spaces
///           with the rule as a bias: Giesen, A trip through the graphics pipeline, 2011.
struct Triangle {
  std::int32_t a[3], b[3];
  std::int64_t c[3];
  std::int32_t min_x, min_y, max_x, max_y;  ///< pixels that may hold a covered sample, not clamped to the image
  std::int32_t x0, y0;                      ///< the first vertex, 1/256 pixel from the top-left corner
  double z0, dzdx, dzdy;                    ///< depth at that vertex, gradients per 1/256 pixel
  float z_low, z_high;                      ///< the least and greatest depth of the three vertices
  std::int32_t id;
};

/// Twice the signed area in (1/256 pixel)²; positive where the vertices run clockwise on the screen (y down).
std::int64_t doubled_area(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r);

/// Sets up the triangle of three screen vertices that need no clipping, in any winding. By the painter's algorithm
/// the whole triangle has its mean depth. Requires: area not 0.
///
/// Exact     edges are exact integers: |a|, |b| <= 2^23, |c| < 2^47.
Triangle make_triangle(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, std::int32_t id,
                       Viewport viewport, const RasterRules& rules = {});

/// A triangle as seen from one tile: edges stepped per pixel in 32 bits, depth in floats.
///
/// Edge k of sample s at pixel (i, j) of the tile is inside where a_k i + b_k j + c_ks >= 0. Depth there is
/// clamp((z_s + dzdy (j - origin_y)) + dzdx (i - origin_x)) with the triangle's own first pixel as origin, so that
/// neither tile nor crop changes its bits.
///
/// Exact     samples of one kind are whole pixels apart, so E = 256 (a i + b j) + C_s and sign E = sign(a i + b j +
///           floor(C_s / 256)); C_s is reduced and clamped to [-2^30, 2^30 - 1], where a clamped edge has one sign in
///           the whole tile (|a i + b j| <= 63 × 2^24 < 2^30).
struct TileTriangle {
  static constexpr int max_samples = 64;
  std::int32_t a[3], b[3];
  std::int32_t c[3][max_samples];
  float z[max_samples];
  float dzdx, dzdy;
  float z_low, z_high;
  std::int32_t origin_x, origin_y;                ///< the triangle's first pixel, relative to the tile
  std::int32_t first_x, first_y, last_x, last_y;  ///< its pixels within the tile; empty if first > last
  std::int32_t id;
};

/// Requires  the tile is 64 × 64 pixels at pixel (tile_x, tile_y); at most TileTriangle::max_samples samples.
void make_tile_triangle(const Triangle& triangle, const SamplePosition* samples, int sample_count, int tile_x,
                        int tile_y, TileTriangle& out);

/// Depth of the triangle at sample s of the tile's pixel (x, y); the same bits in every kernel.
inline float depth_at(const TileTriangle& t, int s, int x, int y) {
  const float row = t.z[s] + t.dzdy * static_cast<float>(y - t.origin_y);
  const float z = row + t.dzdx * static_cast<float>(x - t.origin_x);
  const float raised = z > t.z_low ? z : t.z_low;
  return raised < t.z_high ? raised : t.z_high;
}

/// The greatest depth of a triangle's samples in the tile: rounding is monotone, so it is found at a corner.
inline float max_depth(const TileTriangle& t, int samples) {
  const int x = t.dzdx > 0 ? t.last_x : t.first_x, y = t.dzdy > 0 ? t.last_y : t.first_y;
  float greatest = depth_at(t, 0, x, y);
  for (int s = 1; s < samples; ++s) {
    const float z = depth_at(t, s, x, y);
    greatest = z > greatest ? z : greatest;
  }
  return greatest;
}

}  // namespace zoneplate
