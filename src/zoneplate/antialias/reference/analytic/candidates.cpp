// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace zoneplate::antialias {
namespace {

constexpr int unit = 256;  // lattice units of vertices per pixel

/// Orders triangles nearest first, so that occluders precede occluded triangles; then by position and shape.
bool comes_before(const Triangle& p, const Triangle& q) {
  const auto key = [](const Triangle& t) {
    return std::tie(t.min_y, t.min_x, t.y0, t.x0, t.a[0], t.b[0], t.a[1], t.b[1], t.z0, t.dzdx, t.dzdy, t.id);
  };
  return p.z_high != q.z_high ? p.z_high > q.z_high : key(p) < key(q);
}

/// The minimum and maximum of an edge function over a pixel, relative to its value at the pixel's top-left corner.
struct Range {
  std::int64_t least, greatest;
};
Range range_of(std::int64_t a, std::int64_t b) {
  const std::int64_t across = a * unit, down = b * unit;
  return {std::min<std::int64_t>(across, 0) + std::min<std::int64_t>(down, 0),
          std::max<std::int64_t>(across, 0) + std::max<std::int64_t>(down, 0)};
}

double depth_at_corner(const Triangle& t, int x, int y) {
  return (t.z0 + t.dzdx * (x * unit - t.x0)) + t.dzdy * (y * unit - t.y0);
}

}  // namespace

void PixelCandidates::find(std::span<const ScreenTriangle> triangles, const PixelRect& rect) {
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t p, std::uint32_t q) { return comes_before(triangles[p].shape, triangles[q].shape); });
  const auto pixels = static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height());
  found_.clear();
  hidden_below_.assign(pixels, -1.0);
  for (const std::uint32_t number : order_) collect_pixels(number, triangles[number], rect);
  sort_by_pixel(pixels);
}

void PixelCandidates::collect_pixels(std::uint32_t number, const ScreenTriangle& triangle, const PixelRect& rect) {
  const Triangle& t = triangle.shape;
  const int left = std::max(t.min_x, rect.left), right = std::min(t.max_x + 1, rect.right);
  const int top = std::max(t.min_y, rect.top), bottom = std::min(t.max_y + 1, rect.bottom);
  Range range[3];
  for (std::size_t k = 0; k < 3; ++k) range[k] = range_of(t.a[k], t.b[k]);
  const double zx = t.dzdx * unit, zy = t.dzdy * unit;
  const double lower = std::min(zx, 0.0) + std::min(zy, 0.0), upper = std::max(zx, 0.0) + std::max(zy, 0.0);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      bool covers = true, touches = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t e =
            static_cast<std::int64_t>(t.a[k]) * (x * unit) + static_cast<std::int64_t>(t.b[k]) * (y * unit) + t.c[k];
        touches = touches && e + range[k].greatest > 0;
        covers = covers && e + range[k].least >= 0;
      }
      if (!touches) continue;
      const auto pixel = static_cast<std::uint32_t>((y - rect.top) * rect.width() + x - rect.left);
      const double z = depth_at_corner(t, x, y);
      const double greatest = covers ? z + upper : std::min(z + upper, static_cast<double>(t.z_high));
      if (greatest < hidden_below_[pixel]) continue;
      if (covers && triangle.alpha_mode == AlphaMode::Opaque)
        hidden_below_[pixel] = std::max(hidden_below_[pixel], z + lower);
      found_.push_back({pixel, number, covers, greatest});
    }
}

/// Sorts the candidates by pixel; those of a pixel stay in the order in which they were found.
void PixelCandidates::sort_by_pixel(std::size_t pixels) {
  const auto is_seen = [&](const Candidate& c) { return !(c.max_depth < hidden_below_[c.pixel]); };
  first_.assign(pixels + 1, 0);
  for (const Candidate& c : found_)
    if (is_seen(c)) ++first_[c.pixel + 1];
  for (std::size_t i = 0; i < pixels; ++i) first_[i + 1] += first_[i];
  next_.assign(first_.begin(), first_.end() - 1);
  sorted_.resize(first_.back());
  for (const Candidate& c : found_)
    if (is_seen(c)) sorted_[next_[c.pixel]++] = c;
}

PixelTriangle at_pixel(const ScreenTriangle& triangle, bool covers_pixel, int x, int y) {
  const Triangle& t = triangle.shape;
  PixelTriangle out;
  out.covers_all = covers_pixel;
  out.is_piece = triangle.is_piece;
  out.id = t.id;
  out.alpha_mode = triangle.alpha_mode;
  out.zx = t.dzdx * unit, out.zy = t.dzdy * unit;
  out.z = depth_at_corner(t, x, y);
  if (covers_pixel) return out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = t.a[k], b = t.b[k];
    const std::int64_t e =
        static_cast<std::int64_t>(t.a[k]) * (x * unit) + static_cast<std::int64_t>(t.b[k]) * (y * unit) + t.c[k];
    const double length = std::sqrt(a * a + b * b);
    out.edge[k] = {a / length, b / length, static_cast<double>(e) / (length * unit)};
  }
  return out;
}

}  // namespace zoneplate::antialias
