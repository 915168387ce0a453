// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {

/// RowPitch::of, by fragment.
template <class Int>
[[gnu::always_inline]] inline Int row_pitches(Int width) {
  const auto is_padded = (width > Int(RowPitch::min_padded - 1)) & ((width & Int(RowPitch::multiple - 1)) < Int(1));
  return width + Int(RowPitch::border) + where(is_padded, Int(RowPitch::padding));
}

/// The mip level of a texture at each fragment: its size in 1/32768 texel, and the layout of its texels.
template <class F>
struct MipLevel {
  F width, height;
  typename F::Int columns, rows, pitch, offset;
};

/// The same level for all fragments.
template <class F, class View>
[[gnu::always_inline]] inline MipLevel<F> mip_level(const View& t, std::int32_t level) {
  using Int = typename F::Int;
  const std::int32_t w = t.width[level], h = t.height[level];
  const auto size = [](std::int32_t n) { return F(static_cast<float>(n) * 32768.0f); };
  return {size(w), size(h), Int(w), Int(h), Int(t.pitch(level)), Int(t.offset[level])};
}

/// The level of each fragment.
template <class F, class View>
[[gnu::always_inline]] inline MipLevel<F> mip_levels(const View& t, typename F::Int level) {
  using Int = typename F::Int;
  static_assert(View::max_levels == 16);
  const Int w = Int::look_up(t.width, level), h = Int::look_up(t.height, level);
  return {F::from(w) * F(32768.0f), F::from(h) * F(32768.0f), w, h, row_pitches(w), Int::look_up(t.offset, level)};
}

/// A coordinate wrapped to [0, 1]; NaN gives 0.
template <class F>
[[gnu::always_inline]] inline F wrap(F u, bool mirrors, bool clamps) {
  const F zero(0.0f), one(1.0f);
  F w = u;
  if (mirrors) {
    const F half = u * F(0.5f);
    w = F(2.0f) * (half - floor(half));
    w = select(w > one, F(2.0f) - w, w);
  } else if (!clamps) {
    return max(u - floor(u), zero);
  }
  return min(max(w, zero), one);
}

/// The most frequent sampler, fixed at compile time: repeating, linear within and between mip levels.
struct TrilinearRepeat {
  static constexpr bool mirror_u = false, clamp_u = false, mirror_v = false, clamp_v = false;
  static constexpr bool nearest_magnify = false, nearest_minify = false;
  static constexpr bool has_mips = true, blends_mips = true;
};

template <class Filter>
[[gnu::always_inline]] inline bool may_be_nearest(const Filter& f) {
  return f.nearest_magnify || f.nearest_minify;
}

inline bool is_trilinear_repeat(const SamplerState& f) {
  return !f.mirror_u && !f.clamp_u && !f.mirror_v && !f.clamp_v && !may_be_nearest(f) && f.has_mips && f.blends_mips;
}

/// The two texels of an axis around a wrapped coordinate, counted from the border on, and the weight of the second in
/// 1/32768. The second follows the first, or is the same and has no weight.
template <class F>
struct AxisTaps {
  typename F::Int first, weight;
  typename F::Bool is_same;
};

/// `size` in 1/32768 texel, `count` in texels.
template <class F>
[[gnu::always_inline]] inline AxisTaps<F> axis_taps(F wrapped, F size, typename F::Int count, bool may_be_nearest,
                                                    typename F::Bool is_nearest, bool repeats) {
  using Int = typename F::Int;
  // Centres of texels lie at halves, and the border is one texel wide.
  const F to_first = may_be_nearest ? select(is_nearest, F(32768.0f), F(16384.0f)) : F(16384.0f);
  const Int at = truncate(wrapped * size + to_first);
  Int first = at.template shifted_right<15>(), weight = at & Int(32767);
  if (may_be_nearest) weight = select(is_nearest, Int(0), weight);
  if (repeats) return {first, weight, may_be_nearest ? is_nearest : weight < Int(0)};

  // A coordinate in [0, 1] leaves the level by one texel at most. Without repetition both texels are the same there.
  const auto is_same = (first < Int(1)) | (first > count - Int(1)) | (may_be_nearest ? is_nearest : weight < Int(0));
  first = min(max(first, Int(1)), count);
  return {first, select(is_same, Int(0), weight), is_same};
}

/// log2 of the footprint in texels of level 0, which is w × h, clamped to ±64.
template <class F>
[[gnu::always_inline]] inline F footprint_level(F w, F h, const Footprint& p, int i) {
  const F sx = F::load(p.dudx + i) * w, tx = F::load(p.dvdx + i) * h;
  const F sy = F::load(p.dudy + i) * w, ty = F::load(p.dvdy + i) * h;
  const F square = max(sx * sx + tx * tx, sy * sy + ty * ty);
  return F(0.5f) * coarse_log2(min(max(square, F(0x1p-100f)), F(0x1p100f)));
}

template <class F>
struct WrappedCoordinates {
  F u, v;
  typename F::Bool is_nearest;
};

/// Prefetches a cache line. GCC 12 removes functions and loops that only prefetch, but for the empty statement.
[[gnu::always_inline]] inline void prefetch(const unsigned char* from) {
  __builtin_prefetch(from);
  asm volatile("");
}

/// Where texels lie that a later stage mixes, to prefetch them. The size of the most frequent texels, of four bytes, is
/// known to the compiler.
template <bool is_unorm8>
struct TexelAddress {
  const unsigned char* codes;
  int shift;  ///< log2 of a texel's bytes

  template <class View>
  explicit TexelAddress(const View& t)
      : codes(t.unorm8 != nullptr    ? t.unorm8
              : t.unorm15 != nullptr ? reinterpret_cast<const unsigned char*>(t.unorm15)
              : t.halves != nullptr  ? reinterpret_cast<const unsigned char*>(t.halves)
                                     : reinterpret_cast<const unsigned char*>(t.values)),
        shift(t.unorm8 != nullptr                           ? 2
              : t.unorm15 != nullptr || t.halves != nullptr ? 3
                                                            : 4) {}
  /// How many bytes some texels take.
  [[gnu::always_inline]] std::ptrdiff_t bytes(std::int32_t texels) const {
    return is_unorm8 ? std::ptrdiff_t{texels} * 4 : std::ptrdiff_t{texels} << shift;
  }
  [[gnu::always_inline]] const unsigned char* at(std::int32_t texel) const { return codes + bytes(texel); }
};

/// The mip levels to read.
template <class F>
struct Levels {
  typename F::Int first;
  F mip_weight;  ///< weight of the next level
  typename F::Bool is_minified;
};

template <class F, class Filter>
[[gnu::always_inline]] inline Levels<F> find_levels(F last_level, const Filter& f, F lod) {
  const F clamped = min(max(lod, F(0.0f)), last_level);
  const F fine = f.has_mips ? floor(f.blends_mips ? clamped : clamped + F(0.5f)) : F(0.0f);
  const F mip_weight = f.has_mips && f.blends_mips ? clamped - fine : F(0.0f);
  return {truncate(fine), mip_weight, lod > F(0.0f)};
}

/// The mip levels of fragments, and their weights.
template <class F>
struct Lookup {
  F last_level;
  MipLevel<F> level[2];
  typename F::Int first;       ///< the first level
  typename F::Int mip_weight;  ///< weight of the second level, in 1/32768
  typename F::Bool is_nearest;
  bool is_uniform;             ///< all fragments have the same first level
  std::int32_t pitch[2] = {};  ///< of both levels, if is_uniform
};

template <class F, class View, class Filter>
[[gnu::always_inline]] inline void set_levels(const View& t, const Filter& f, typename F::Int first, Lookup<F>& at) {
  using Int = typename F::Int;
  const bool has_second = f.has_mips && f.blends_mips;
  at.first = first;
  at.is_uniform = first.is_uniform();
  if (at.is_uniform) {
    at.level[0] = mip_level<F>(t, first.first());
    at.pitch[0] = t.pitch(first.first());
    if (has_second) {
      const std::int32_t second = first.first() + 1 < t.levels ? first.first() + 1 : t.levels - 1;
      at.level[1] = mip_level<F>(t, second);
      at.pitch[1] = t.pitch(second);
    }
  } else {
    at.level[0] = mip_levels<F>(t, first);
    if (has_second) at.level[1] = mip_levels<F>(t, min(first + Int(1), Int(t.levels - 1)));
  }
}

/// Updates `at`, the look-up of the fragments before, which mostly read the same levels: then the texel addresses do
/// not depend on this computation. Returns whether the levels are others.
template <class F, class View, class Filter>
[[gnu::always_inline]] inline bool find_lookup(const View& t, const Filter& f, F lod, Lookup<F>& at) {
  using Int = typename F::Int;
  const Levels<F> levels = find_levels<F>(at.last_level, f, lod);
  const F minify(f.nearest_minify ? 1.0f : 0.0f), magnify(f.nearest_magnify ? 1.0f : 0.0f);
  const bool changes = !levels.first.equals(at.first);
  if (changes) set_levels(t, f, levels.first, at);
  at.mip_weight = min(truncate(levels.mip_weight * F(32768.0f) + F(0.5f)), Int(32767));
  at.is_nearest = select(levels.is_minified, minify, magnify) > F(0.5f);
  return changes;
}

/// The look-up of fragments at the first level.
template <class F, class View, class Filter>
[[gnu::always_inline]] inline Lookup<F> begin_lookup(const View& t, const Filter& f) {
  Lookup<F> at;
  at.last_level = F(static_cast<float>(t.levels - 1));
  set_levels(t, f, typename F::Int(0), at);
  return at;
}

/// The taps of one level: the upper and lower left texels, and the weights of the right and lower ones.
template <class F>
struct TapsOfLevel {
  typename F::Int upper, lower, right, down;
};

template <class F, class Filter>
[[gnu::always_inline]] inline TapsOfLevel<F> taps_of_level(const Filter& f, const WrappedCoordinates<F>& p,
                                                           const MipLevel<F>& level) {
  using Int = typename F::Int;
  const bool nearest = may_be_nearest(f), repeats_v = !f.mirror_v && !f.clamp_v;
  const AxisTaps<F> x = axis_taps(p.u, level.width, level.columns, nearest, p.is_nearest, !f.mirror_u && !f.clamp_u);
  const AxisTaps<F> y = axis_taps(p.v, level.height, level.rows, nearest, p.is_nearest, repeats_v);
  const Int upper = level.offset + y.first * level.pitch + x.first;
  const Int below = repeats_v && !nearest ? level.pitch : select(y.is_same, Int(0), level.pitch);
  return {upper, upper + below, x.weight, y.weight};
}

/// Stores the taps of one level, and prefetches texels at the ends of each group of eight fragments, which mostly are a
/// row.
template <class F, class Address, class Filter>
[[gnu::always_inline]] inline void store_level(const Address& address, const Filter& f, const WrappedCoordinates<F>& p,
                                               const MipLevel<F>& level, Taps& out, int which, int i) {
  const TapsOfLevel<F> taps = taps_of_level<F>(f, p, level);
  taps.upper.store(out.upper[which] + i);
  taps.right.store_by_fours(taps.down, out.bilinear_weight[which], i);
  taps.lower.store(out.lower[which] + i);
  prefetch(address.at(taps.upper.first()));
  prefetch(address.at(taps.lower.first()));
  // A row of the second level has half as many texels.
  if (which > 0) return;
  const std::int32_t *const upper = out.upper[0] + i, *const lower = out.lower[0] + i;
  for (int k = 7; k < F::lanes; k += 8) {
    prefetch(address.at(upper[k])), prefetch(address.at(lower[k]));
    if (k + 1 < F::lanes) prefetch(address.at(upper[k + 1])), prefetch(address.at(lower[k + 1]));
  }
}

/// Stores the taps of fragments at (u, v), from the i-th of `out` on.
template <class F, class Address, class Filter>
[[gnu::always_inline]] inline void store_taps(const Address& address, const Filter& f, const Lookup<F>& at, F u, F v,
                                              Taps& out, int i) {
  at.mip_weight.store_by_fours(at.mip_weight, out.mip_weight, i);
  const WrappedCoordinates<F> p{wrap(u, f.mirror_u, f.clamp_u), wrap(v, f.mirror_v, f.clamp_v), at.is_nearest};
  for (int which = 0; which < (f.has_mips && f.blends_mips ? 2 : 1); ++which)
    store_level<F>(address, f, p, at.level[which], out, which, i);
}

/// `at` is a copy, so that its pointers are loaded once and not again after each store.
template <class F, class Address, class View, class Filter>
[[gnu::always_inline]] inline void compute_all_taps(const Address address, const View& t, const Filter& f,
                                                    const Footprint at, Taps& out, int count) {
  static constexpr bool none[Taps::groups] = {};
  static constexpr int step = F::lanes < 8 ? 8 : F::lanes;
  const bool* const repeats = at.repeats != nullptr ? at.repeats : none;
  // True if all fragments from i on, of one group or two, have the levels of the fragments before them. A vector of two
  // groups repeats the vector before it if that had one footprint.
  const auto is_known = [&](int i) {
    const int g = i / 8;
    if constexpr (step == 8) return repeats[g];
    return repeats[g] && repeats[g + 1] && repeats[g - 1];
  };
  // The levels are found in a loop before the addresses, because both are long dependency chains.
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0]));
  int leader = 0;
  for (int i = 0; i < count; i += step) {
    if (is_known(i)) continue;
    for (int k = i; k < i + step; k += F::lanes) footprint_level(w, h, at, k).store(out.lod + k);
    if constexpr (step == 8) continue;
    for (int k = i; k < i + step; k += 8) {
      if (repeats[k / 8]) {
        std::copy_n(out.lod + leader, 8, out.lod + k);
      } else {
        leader = k;
      }
    }
  }
  Lookup<F> lookup = begin_lookup<F>(t, f);
  for (int i = 0; i < count; i += step) {
    const bool is_same = is_known(i);
    for (int k = i; k < i + step; k += F::lanes) {
      if (!is_same) find_lookup<F>(t, f, F::load(out.lod + k), lookup);
      store_taps<F>(address, f, lookup, F::load(at.u + k), F::load(at.v + k), out, k);
    }
  }
}

/// The stage `compute_taps` of shade/texture/filtering.h.
template <class F, class View>
void compute_taps(const View& t, const SamplerState& f, const Footprint& footprint, Taps& out, int count) {
  if (is_trilinear_repeat(f) && t.unorm8 != nullptr)
    return compute_all_taps<F>(TexelAddress<true>(t), t, TrilinearRepeat{}, footprint, out, count);
  const TexelAddress<false> address(t);
  if (is_trilinear_repeat(f)) return compute_all_taps<F>(address, t, TrilinearRepeat{}, footprint, out, count);
  compute_all_taps<F>(address, t, f, footprint, out, count);
}

}  // namespace zoneplate
