#pragma once

#include <cstddef>

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

/// What most samplers are: repeating, linear within and between levels. Known when this is compiled.
struct UsualFiltering {
  static constexpr bool mirror_u = false, clamp_u = false, mirror_v = false, clamp_v = false;
  static constexpr bool nearest_magnify = false, nearest_minify = false;
  static constexpr bool has_levels = true, blends_levels = true;
};

template <class Filter>
[[gnu::always_inline]] inline bool may_be_nearest(const Filter& f) {
  return f.nearest_magnify || f.nearest_minify;
}

/// The two texels of an axis around a wrapped coordinate, and the weight of the second in 1/32768.
template <class F>
struct AxisTaps {
  typename F::Int first, second, weight;
};

template <class F>
[[gnu::always_inline]] inline AxisTaps<F> axis_taps(F wrapped, typename F::Int size, bool may_be_nearest,
                                                    typename F::Bool is_nearest, bool repeats) {
  using Int = typename F::Int;
  const F at = wrapped * F::from(size);
  const F shifted = may_be_nearest ? select(is_nearest, at, at - F(0.5f)) : at - F(0.5f);
  const F whole = floor(shifted);
  const Int i = truncate(whole);
  const Int none(0), last = size - Int(1), next = i + Int(1);
  Int weight = min(truncate((shifted - whole) * F(32768.0f) + F(0.5f)), Int(32767));
  if (may_be_nearest) weight = select(is_nearest, none, weight);

  // A coordinate in [0, 1] leaves the level by one texel at most. Where it does not repeat, both are the same there.
  if (repeats) {
    Int first = select(i < none, last, i), second = select(next > last, none, next);
    if (may_be_nearest) first = select(i > last, none, first);
    return {first, second, weight};
  }
  const Int first = min(max(i, none), last), second = min(max(next, none), last);
  return {first, second, select(second > first, weight, none)};
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

/// Asks for texels that will be mixed some stages later.
template <class View>
[[gnu::always_inline]] inline void fetch_ahead(const View& t, std::int32_t texel) {
  const std::ptrdiff_t code = std::ptrdiff_t{4} * texel;
  if (t.codes8 != nullptr) {
    __builtin_prefetch(t.codes8 + code);
  } else {
    __builtin_prefetch(t.codes15 + code);
  }
}

template <class F, class View, class Filter>
[[gnu::always_inline]] inline void store_level(const View& t, const Filter& f, const WrappedPoint<F>& p,
                                               typename F::Int level, Taps& out, int which, int i) {
  using Int = typename F::Int;
  const LevelPlace<F> place = find_level<F>(t, level);
  const bool nearest = may_be_nearest(f);
  const AxisTaps<F> x = axis_taps(p.u, place.width, nearest, p.is_nearest, !f.mirror_u && !f.clamp_u);
  const AxisTaps<F> y = axis_taps(p.v, place.height, nearest, p.is_nearest, !f.mirror_v && !f.clamp_v);
  const Int pitch = place.width + Int(1), left = place.offset + x.first;
  (left + y.first * pitch).store(out.upper[which] + i);
  (left + y.second * pitch).store(out.lower[which] + i);
  x.weight.store_narrow(out.right[which] + i);
  y.weight.store_narrow(out.down[which] + i);
  for (const int end : {0, F::lanes - 1}) {
    fetch_ahead(t, out.upper[which][i + end]);
    fetch_ahead(t, out.lower[which][i + end]);
  }
}

/// The levels to look at.
template <class F>
struct Levels {
  typename F::Int first;
  F blend;  ///< weight of the next one
  typename F::Bool is_minified;
};

template <class F, class View, class Filter>
[[gnu::always_inline]] inline Levels<F> find_levels(const View& t, const Filter& f, F detail) {
  const F clamped = min(max(detail, F(0.0f)), F(static_cast<float>(t.levels - 1)));
  const F fine = f.has_levels ? floor(f.blends_levels ? clamped : clamped + F(0.5f)) : F(0.0f);
  const F blend = f.has_levels && f.blends_levels ? clamped - fine : F(0.0f);
  return {truncate(fine), blend, detail > F(0.0f)};
}

/// The taps of points at (u, v), the i-th of `out` and on.
template <class F, class View, class Filter>
[[gnu::always_inline]] inline void store_taps(const View& t, const Filter& f, const Levels<F>& levels, F u, F v,
                                              Taps& out, int i) {
  using Int = typename F::Int;
  min(truncate(levels.blend * F(32768.0f) + F(0.5f)), Int(32767)).store_narrow(out.blend + i);
  const F minify(f.nearest_minify ? 1.0f : 0.0f), magnify(f.nearest_magnify ? 1.0f : 0.0f);
  const WrappedPoint<F> p{wrap(u, f.mirror_u, f.clamp_u), wrap(v, f.mirror_v, f.clamp_v),
                          select(levels.is_minified, minify, magnify) > F(0.5f)};
  store_level<F>(t, f, p, levels.first, out, 0, i);
  if (f.has_levels && f.blends_levels)
    store_level<F>(t, f, p, min(levels.first + Int(1), Int(t.levels - 1)), out, 1, i);
}

template <class F, class View, class Filter>
[[gnu::always_inline]] inline void find_all_taps(const View& t, const Filter& f, const Footprint& at, Taps& out,
                                                 int count) {
  // Apart from the addresses, because both are long chains of operations that wait for each other.
  for (int i = 0; i < count; i += F::lanes) footprint_level<F>(t, at, i).store(out.detail + i);
  for (int i = 0; i < count; i += F::lanes)
    store_taps<F>(t, f, find_levels<F>(t, f, F::load(out.detail + i)), F::load(at.u + i), F::load(at.v + i), out, i);
}

/// The stage `find_taps` of shade/filtering.h.
template <class F, class View>
void find_taps(const View& t, const Filtering& f, const Footprint& footprint, Taps& out, int count) {
  const bool is_usual =
      !f.mirror_u && !f.clamp_u && !f.mirror_v && !f.clamp_v && !may_be_nearest(f) && f.has_levels && f.blends_levels;
  if (is_usual) return find_all_taps<F>(t, UsualFiltering{}, footprint, out, count);
  find_all_taps<F>(t, f, footprint, out, count);
}

/// Eight points' longer axes of their footprints, and the probes along them.
struct Probes {
  alignas(64) float du[8], dv[8];  ///< the longer axis
  alignas(64) float count[8], detail[8];
  float most = 1;
};

template <class F, class View>
[[gnu::always_inline]] inline void find_probes(const View& t, const Filtering& f, const Footprint& p, int first,
                                               Probes& out) {
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0])), one(1.0f);
  for (int k = 0; k < 8; k += F::lanes) {
    const int i = first + k;
    const F ux = F::load(p.dudx + i), vx = F::load(p.dvdx + i), uy = F::load(p.dudy + i), vy = F::load(p.dvdy + i);
    const F sx = ux * w, tx = vx * h, sy = uy * w, ty = vy * h;
    const F x = min(max(sx * sx + tx * tx, F(0x1p-60f)), F(0x1p60f));
    const F y = min(max(sy * sy + ty * ty, F(0x1p-60f)), F(0x1p60f));
    const auto is_wide = x > y;
    const F longer = max(x, y), ratio = sqrt(longer / min(x, y));

    // As many as the footprint is longer than wide; but no more than it has texels.
    const F wanted = min(min(-floor(-ratio), -floor(-sqrt(longer))), F(static_cast<float>(f.anisotropy)));
    const F count = max(wanted, one);
    select(is_wide, ux, uy).store(out.du + k);
    select(is_wide, vx, vy).store(out.dv + k);
    count.store(out.count + k);
    (F(0.5f) * log2(longer / (count * count))).store(out.detail + k);
  }
  out.most = 1;
  for (const float n : out.count) out.most = out.most < n ? n : out.most;
}

/// The stage `sample_anisotropic` of shade/filtering.h; mix(taps, out) mixes the first eight taps.
template <class F, class View, class Mix>
[[gnu::always_inline]] inline void sample_anisotropic(const View& t, const Filtering& f, const Footprint& at,
                                                      float* const out[4], int count, Mix mix) {
  Taps taps;
  Probes probes;
  alignas(64) float mixed[4][8];
  float* const probe[4] = {mixed[0], mixed[1], mixed[2], mixed[3]};
  const F one(1.0f);
  for (int first = 0; first < count; first += 8) {
    find_probes<F>(t, f, at, first, probes);
    for (float n = 1; n <= probes.most; n += 1) {
      for (int k = 0; k < 8; k += F::lanes) {
        const F all = F::load(probes.count + k);
        const F along = min(F(n), all) / (all + one) - F(0.5f);
        const F u = F::load(at.u + first + k) + F::load(probes.du + k) * along;
        const F v = F::load(at.v + first + k) + F::load(probes.dv + k) * along;
        store_taps<F>(t, f, find_levels<F>(t, f, F::load(probes.detail + k)), u, v, taps, k);
      }
      mix(taps, probe);
      for (int k = 0; k < 8; k += F::lanes) {
        const F all = F::load(probes.count + k);
        const F weight = select(F(n) > all, F(0.0f), one / all);
        for (int c = 0; c < 4; ++c) {
          float* const to = out[c] + first + k;
          const F more = F::load(probe[c] + k) * weight;
          (n > 1 ? F::load(to) + more : more).store(to);
        }
      }
    }
  }
}

}  // namespace zoneplate
