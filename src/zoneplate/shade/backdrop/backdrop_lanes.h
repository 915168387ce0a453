// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/raster/types/batch.h"
#include "zoneplate/shade/backdrop/backdrop_view.h"

/// Look-ups in the image behind transmissive surfaces, over the lane types of math/lanes.h.
namespace zoneplate {

/// Places in images, in pixels from the top-left corner.
template <class F>
struct ImagePlace {
  F x, y;
  typename F::Int first;  ///< where the image begins, in texels
};

/// Where the images begin that fragments i, i + 1, ... of a batch refract.
template <class F>
[[gnu::always_inline]] inline typename F::Int first_texels(const BackdropView& b, const FragmentBatch& batch, int i) {
  using Int = typename F::Int;
  if (b.first_texel == nullptr) return Int(0);
  alignas(64) std::int32_t first[F::lanes];
  for (int lane = 0; lane < F::lanes; ++lane) {
    // Entries from padded() on are undefined.
    const int entry = std::min(i + lane, batch.padded() - 1);
    first[lane] = b.first_texel[batch.instance[batch.leader(static_cast<std::size_t>(entry))]];
  }
  return Int::load(first);
}

/// Where points of the world are seen. Points behind the eye have some place.
template <class F>
[[gnu::always_inline]] inline ImagePlace<F> image_place(const BackdropView& b, Vector<F> p, typename F::Int first) {
  const auto row = [&](int r) {
    const float* m = b.clip_from_world + r;
    return F(m[0]) * p.x + F(m[4]) * p.y + F(m[8]) * p.z + F(m[12]);
  };
  const F half(0.5f), inverse = half / max(row(3), F(1e-6f));
  return {(row(0) * inverse + half) * F(static_cast<float>(b.width[0])),
          (half - row(1) * inverse) * F(static_cast<float>(b.height[0])), first};
}

/// Colours of the image, premultiplied, and their alpha.
template <class F>
struct BackdropColor {
  Vector<F> color;
  F alpha;
};

template <class F>
[[gnu::always_inline]] inline BackdropColor<F> operator*(const BackdropColor<F>& a, F weight) {
  return {a.color * weight, a.alpha * weight};
}
template <class F>
[[gnu::always_inline]] inline BackdropColor<F> operator+(const BackdropColor<F>& a, const BackdropColor<F>& b) {
  return {a.color + b.color, a.alpha + b.alpha};
}

/// The bilinear mean of the four texels about places of a level each, in texels, whose centres have whole coordinates;
/// the border continues beyond it.
template <class F>
[[gnu::always_inline]] inline BackdropColor<F> bilinear_texels(const BackdropView& b, ImagePlace<F> at,
                                                               typename F::Int level) {
  using Int = typename F::Int;
  const Int width = Int::gather(b.width, level), height = Int::gather(b.height, level), one(1);
  const auto bounded = [](F x, Int size) { return min(max(x, F(0.0f)), F::from(size - Int(1))); };
  const F x = bounded(at.x, width), y = bounded(at.y, height);
  const Int left = truncate(x), top = truncate(y);
  const F across = x - F::from(left), down = y - F::from(top);
  const Int right = min(left + one, width - one), bottom = min(top + one, height - one);
  const Int first = at.first + Int::gather(b.offset, level);

  F texel[4][4];
  const auto load = [&](Int column, Int row, F(&out)[4]) {
    alignas(64) std::int32_t index[F::lanes];
    (first + row * width + column).store(index);
    F::load_quads([&](int lane) { return b.texels + std::ptrdiff_t{4} * index[lane]; }, out);
  };
  load(left, top, texel[0]), load(right, top, texel[1]), load(left, bottom, texel[2]), load(right, bottom, texel[3]);
  const auto mean = [&](int c) {
    const F above = texel[0][c] + (texel[1][c] - texel[0][c]) * across;
    const F below = texel[2][c] + (texel[3][c] - texel[2][c]) * across;
    return above + (below - above) * down;
  };
  return {{mean(0), mean(1), mean(2)}, mean(3)};
}

/// Where a bilinear look-up gives two of the four weights of the cubic B-spline, and their sum.
template <class F>
struct SplinePair {
  F place[2], weight[2];

  [[gnu::always_inline]] explicit SplinePair(F x) {
    const F whole = floor(x), t = x - whole, one(1.0f), sixth(1.0f / 6);
    const F r = one - t, t2 = t * t, t3 = t2 * t;
    const F first = r * r * r * sixth, last = t3 * sixth;
    const F second = (t3 * F(3.0f) - t2 * F(6.0f) + F(4.0f)) * sixth;
    weight[0] = first + second, weight[1] = one - weight[0];
    place[0] = whole - one + second / weight[0];
    place[1] = whole + one + last / weight[1];
  }
};

/// The image at places, in pixels of the whole image, of a level each: bilinear in the image itself, by the cubic
/// B-spline in the blurred levels, whose texels would be visible otherwise.
///
/// Source    the sums of bilinear look-ups: Sigg and Hadwiger, Fast Third-Order Texture Filtering, GPU Gems 2, 2005.
template <class F>
[[gnu::always_inline]] inline BackdropColor<F> backdrop_texels(const BackdropView& b, ImagePlace<F> at,
                                                               typename F::Int level) {
  const F scale = exp2(-F::from(level)), half(0.5f);
  const ImagePlace<F> centre{at.x * scale - half, at.y * scale - half, at.first};
  const auto is_sharp = F::from(level) < half;
  const BackdropColor<F> sharp = bilinear_texels(b, centre, level);
  if (all(is_sharp)) return sharp;
  const SplinePair<F> x(centre.x), y(centre.y);
  const auto tap = [&](int i, int j) {
    return bilinear_texels(b, ImagePlace<F>{x.place[i], y.place[j], at.first}, level) * x.weight[i];
  };
  const BackdropColor<F> smooth = (tap(0, 0) + tap(1, 0)) * y.weight[0] + (tap(0, 1) + tap(1, 1)) * y.weight[1];
  return {select(is_sharp, sharp.color, smooth.color), select(is_sharp, sharp.alpha, smooth.alpha)};
}

/// The image about places, of a level each that need not be whole.
template <class F>
[[gnu::always_inline]] inline BackdropColor<F> blurred_backdrop(const BackdropView& b, ImagePlace<F> at, F level) {
  using Int = typename F::Int;
  const Int lower = truncate(level), upper = min(lower + Int(1), Int(b.levels - 1));
  const F part = level - F::from(lower);
  const BackdropColor<F> sharp = backdrop_texels(b, at, lower);
  if (none(part > F(0.0f))) return sharp;
  const BackdropColor<F> blurred = backdrop_texels(b, at, upper);
  return {sharp.color + (blurred.color - sharp.color) * part, sharp.alpha + (blurred.alpha - sharp.alpha) * part};
}

/// The image about places, blurred as a wall of a roughness in [0, 1] blurs it: not at all at 0, over its whole width
/// at 1, and over the same part of it whatever its size. What is empty stays as sharp as it is and has no part in the
/// colour: a wall in front of an opaque surface is opaque however far it blurs.
///
/// Source    the level roughness × log2(width) of glTF's sample viewer and three.js, for the width of 1024 that the
///           former draws this image with.
template <class F>
[[gnu::always_inline]] inline BackdropColor<F> backdrop_color(const BackdropView& b, ImagePlace<F> at, F roughness) {
  constexpr float levels = 10, pixels = 1024;  // 2^levels
  const F last(static_cast<float>(b.levels - 1)), zero(0.0f), one(1.0f);
  const F part_of_width = (exp2(roughness * F(levels)) - one) * F(1 / (pixels - 1));
  const F level = min(max(log2(one + part_of_width * F(static_cast<float>(b.width[0]))), zero), last);
  const BackdropColor<F> blurred = blurred_backdrop(b, at, level);
  // Weights of the look-ups add up to 1 but for rounding.
  constexpr float full = 1 - 1e-5f, least = 1e-6f;
  const auto is_full = (blurred.alpha > F(full)) | (level == zero);
  if (all(is_full)) return blurred;
  const F alpha = backdrop_texels(b, at, typename F::Int(0)).alpha;
  const F scale = select(is_full, one, alpha / max(blurred.alpha, F(least)));
  return {blurred.color * scale, select(is_full, blurred.alpha, alpha)};
}

}  // namespace zoneplate
