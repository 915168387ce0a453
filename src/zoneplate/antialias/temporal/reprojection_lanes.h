// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/past_pixels_lanes.h"
#include "zoneplate/antialias/temporal/resolve.h"

/// Where a pixel's history is, and whether the last frame had the same surface there, over a lane type of math/lanes.h.
namespace zoneplate::stages {

using antialias::TemporalParts;
using antialias::TemporalRow;

/// The surface whose motion a pixel takes.
template <class F>
struct Followed {
  F motion[2];
  F nearness, surface, last_depth, last_nearness;
};

template <class F>
[[gnu::always_inline]] inline Followed<F> surface_at(const TemporalRow& row, std::ptrdiff_t i) {
  return {{F::load(row.motion[0] + i), F::load(row.motion[1] + i)},
          F::load(row.nearness + i),
          F::load(row.surface + i),
          F::load(row.last_depth + i),
          F::load(row.last_nearness + i)};
}

struct PixelOffset {
  int x, y;
};
constexpr PixelOffset around_square[] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
constexpr PixelOffset around_cross[] = {{-2, -2}, {2, -2}, {-2, 2}, {2, 2}};

template <class F, std::size_t n>
[[gnu::always_inline]] inline Followed<F> nearest_of(const PixelOffset (&offsets)[n], const TemporalRow& row,
                                                     std::ptrdiff_t i) {
  Followed<F> best = surface_at<F>(row, i);
  for (const PixelOffset o : offsets) {
    const std::ptrdiff_t at = i + o.x + o.y * row.stride;
    const auto is_nearer = F::load(row.nearness + at) > best.nearness;
    if (none(is_nearer)) continue;
    const Followed<F> other = surface_at<F>(row, at);
    for (int k = 0; k < 2; ++k) best.motion[k] = select(is_nearer, other.motion[k], best.motion[k]);
    best.nearness = select(is_nearer, other.nearness, best.nearness);
    best.surface = select(is_nearer, other.surface, best.surface);
    best.last_depth = select(is_nearer, other.last_depth, best.last_depth);
    best.last_nearness = select(is_nearer, other.last_nearness, best.last_nearness);
  }
  return best;
}

template <class F>
[[gnu::always_inline]] inline Followed<F> followed_surface(const TemporalRow& row, TemporalParts::Dilation dilation,
                                                           std::ptrdiff_t i) {
  if (dilation == TemporalParts::Dilation::Square) return nearest_of<F>(around_square, row, i);
  if (dilation == TemporalParts::Dilation::Cross) return nearest_of<F>(around_cross, row, i);
  return surface_at<F>(row, i);
}

/// A position of the last frame: a pixel, and a fraction of the distance to the next one to the right and below.
///
/// Motion is rounded to 1/1024 pixel: motion by whole pixels then moves colours without filtering them.
template <class F>
struct Source {
  F first[2];  ///< the pixel: column, row
  F fraction[2];
  F motion[2];  ///< rounded
  typename F::Bool is_inside;

  [[gnu::always_inline]] Source(const Followed<F>& s, const TemporalRow& row, std::ptrdiff_t i) {
    const F here[2] = {F::load(row.column + i), F(static_cast<float>(row.y))};
    const F size[2] = {F(static_cast<float>(row.width)), F(static_cast<float>(row.height))};
    const F half(0.5f), limit(65536.0f);
    is_inside = half > F(0.0f);
    for (int k = 0; k < 2; ++k) {
      const F clamped = max(min(s.motion[k], limit), -limit);
      motion[k] = floor(clamped * F(1024.0f) + half) * F(1.0f / 1024);
      const F whole = floor(-motion[k]);
      fraction[k] = -motion[k] - whole;
      first[k] = here[k] + whole;
      const F centre = first[k] + fraction[k] + half;
      is_inside = is_inside & (centre >= F(0.0f)) & (size[k] >= centre);
    }
  }
  [[gnu::always_inline]] bool is_at_rest() const {
    const F zero(0.0f);
    return all((motion[0] == zero) & (motion[1] == zero));
  }
};

/// The pixels of the last frame around the source, and around the pixel nearest to it.
template <class F>
[[gnu::always_inline]] inline PastPixels<F> pixels_around(const TemporalRow& row, const Source<F>& source,
                                                          std::ptrdiff_t i) {
  return {source.first[0], source.first[1], row.width, row.height, F::load(row.column + i), i, 2};
}
template <class F>
[[gnu::always_inline]] inline PastPixels<F> nearest_pixels(const TemporalRow& row, const Source<F>& source,
                                                           std::ptrdiff_t i) {
  const F half(0.5f);
  return {source.first[0] + floor(source.fraction[0] + half),
          source.first[1] + floor(source.fraction[1] + half),
          row.width,
          row.height,
          F::load(row.column + i),
          i,
          1};
}

/// True where one of the 3 × 3 surfaces around the source allows history, by Rejection::Depth, Id or Both.
template <class F>
[[gnu::always_inline]] inline typename F::Bool has_surface(const TemporalRow& row, const TemporalParts& parts,
                                                           const Followed<F>& s, const PastPixels<F>& past) {
  using Rejection = TemporalParts::Rejection;
  const F one(1.0f);
  const F nearest = s.last_depth * (one - F(parts.tolerance)), farthest = s.last_depth * (one + F(parts.tolerance));
  const auto allows = [&](int dx, int dy) {
    const auto is_same = past.value(row.past_surface, dx, dy) == s.surface;
    if (parts.rejection == Rejection::Id) return is_same;
    const F depth = past.value(row.past_depth, dx, dy);
    const auto is_behind = depth >= nearest;
    if (parts.rejection == Rejection::Depth) return is_behind;
    return (is_same & is_behind & (farthest >= depth)) | (depth > farthest);
  };
  // Nearly always the middle one does.
  auto found = allows(0, 0);
  for (const PixelOffset o : around_square) {
    if (all(found)) break;
    found = found | allows(o.x, o.y);
  }
  return found;
}

}  // namespace zoneplate::stages
