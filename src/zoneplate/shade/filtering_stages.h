#pragma once

#include "zoneplate/shade/filtering.h"

namespace zoneplate {

/// The size of a texture's level at each point, and where its texels begin.
template <class F>
struct LevelPlace {
  typename F::Int width, height, offset;
};

/// Points near each other mostly share a level, which then is looked up once.
template <class F, class View>
[[gnu::always_inline]] inline LevelPlace<F> find_level(const View& t, typename F::Int level) {
  using Int = typename F::Int;
  if (level.is_uniform()) {
    const std::int32_t l = level.first();
    return {Int(t.width[l]), Int(t.height[l]), Int(t.offset[l])};
  }
  return {Int::gather(t.width, level), Int::gather(t.height, level), Int::gather(t.offset, level)};
}

/// A coordinate brought into [0, 1]; NaN gives 0.
template <class F>
[[gnu::always_inline]] inline F wrap(F u, bool mirrors, bool clamps) {
  const F zero(0.0f), one(1.0f);
  F w = u;
  if (mirrors) {
    const F half = u * F(0.5f);
    w = F(2.0f) * (half - floor(half));
    w = select(w > one, F(2.0f) - w, w);
  } else if (!clamps) {
    w = u - floor(u);
  }
  return min(max(w, zero), one);
}

/// The two texels of an axis around a wrapped coordinate, and the weight of the second.
template <class F>
struct AxisTaps {
  typename F::Int first, second;
  F weight;
};

template <class F>
[[gnu::always_inline]] inline AxisTaps<F> axis_taps(F wrapped, typename F::Int size, typename F::Bool is_nearest,
                                                    bool repeats) {
  using Int = typename F::Int;
  const F at = wrapped * F::from(size);
  const F shifted = select(is_nearest, at, at - F(0.5f));
  const F whole = floor(shifted);
  const Int i = truncate(whole);
  const Int j = select(is_nearest, i, i + Int(1));
  const F weight = select(is_nearest, F(0.0f), shifted - whole);

  // A coordinate in [0, 1] leaves the level by one texel at most.
  const Int last = size - Int(1), none(0);
  if (repeats) return {select(i < none, last, select(i > last, none, i)), select(j > last, none, j), weight};
  return {min(max(i, none), last), min(max(j, none), last), weight};
}

/// log2 of the footprint in texels of level 0, clamped to ±64.
template <class F, class View>
[[gnu::always_inline]] inline F footprint_level(const View& t, const Footprint& p, int i) {
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0]));
  const F sx = F::load(p.dudx + i) * w, tx = F::load(p.dvdx + i) * h;
  const F sy = F::load(p.dudy + i) * w, ty = F::load(p.dvdy + i) * h;
  const F square = max(sx * sx + tx * tx, sy * sy + ty * ty);
  return F(0.5f) * log2(min(max(square, F(0x1p-100f)), F(0x1p100f)));
}

template <class F>
struct WrappedPoint {
  F u, v;
  typename F::Bool is_nearest;
};

template <class F, class View>
[[gnu::always_inline]] inline void store_taps(const View& t, const Filtering& f, const WrappedPoint<F>& p,
                                              typename F::Int level, Taps& out, int which, int i) {
  const LevelPlace<F> place = find_level<F>(t, level);
  const AxisTaps<F> x = axis_taps(p.u, place.width, p.is_nearest, !f.mirror_u && !f.clamp_u);
  const AxisTaps<F> y = axis_taps(p.v, place.height, p.is_nearest, !f.mirror_v && !f.clamp_v);
  const auto upper = place.offset + y.first * place.width, lower = place.offset + y.second * place.width;
  (upper + x.first).store(out.texel[which][0] + i);
  (upper + x.second).store(out.texel[which][1] + i);
  (lower + x.first).store(out.texel[which][2] + i);
  (lower + x.second).store(out.texel[which][3] + i);
  x.weight.store(out.right[which] + i);
  y.weight.store(out.down[which] + i);
}

/// The stage `find_taps` of shade/filtering.h.
template <class F, class View>
void find_taps(const View& t, const Filtering& f, const Footprint& footprint, Taps& out, int count) {
  using Int = typename F::Int;
  const F last_level(static_cast<float>(t.levels - 1));
  for (int i = 0; i < count; i += F::lanes) {
    const F detail = footprint_level<F>(t, footprint, i);
    const F clamped = min(max(detail, F(0.0f)), last_level);
    const F fine = f.has_levels ? floor(f.blends_levels ? clamped : clamped + F(0.5f)) : F(0.0f);
    const F blend = f.has_levels && f.blends_levels ? clamped - fine : F(0.0f);
    blend.store(out.blend + i);

    const auto is_minified = detail > F(0.0f);
    const F minify(f.nearest_minify ? 1.0f : 0.0f), magnify(f.nearest_magnify ? 1.0f : 0.0f);
    const WrappedPoint<F> p{wrap(F::load(footprint.u + i), f.mirror_u, f.clamp_u),
                            wrap(F::load(footprint.v + i), f.mirror_v, f.clamp_v),
                            select(is_minified, minify, magnify) > F(0.5f)};
    const Int level = truncate(fine);
    store_taps<F>(t, f, p, level, out, 0, i);
    if (f.has_levels && f.blends_levels) {
      store_taps<F>(t, f, p, min(level + Int(1), Int(t.levels - 1)), out, 1, i);
    }
  }
}

}  // namespace zoneplate
