// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "zoneplate/shade/texture/filtering_lanes.h"

/// The stage `sample_anisotropic` of shade/texture/filtering.h, over the lane types of math/lanes.h.
namespace zoneplate {

/// The longer axes of the fragments' footprints, the numbers of probes along them, and the probes' LOD.
struct Probes {
  alignas(64) float du[Taps::padded_capacity], dv[Taps::padded_capacity];
  alignas(64) float count[Taps::padded_capacity], lod[Taps::padded_capacity];
};

template <class F, class View>
[[gnu::always_inline]] inline void compute_probes(const View& t, int anisotropy, const Footprint& p, int i,
                                                  Probes& out) {
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0])), one(1.0f);
  const float most = static_cast<float>(anisotropy);
  const F ux = F::load(p.dudx + i), vx = F::load(p.dvdx + i), uy = F::load(p.dudy + i), vy = F::load(p.dvdy + i);
  const F sx = ux * w, tx = vx * h, sy = uy * w, ty = vy * h;
  const F x = min(max(sx * sx + tx * tx, F(0x1p-60f)), F(0x1p60f));
  const F y = min(max(sy * sy + ty * ty, F(0x1p-60f)), F(0x1p60f));
  const auto is_wide = x > y;
  const F longer = max(x, y);

  const F width = max(min(longer, max(min(x, y), one)), longer * F(1 / (most * most)));
  const F count = max(-floor(sqrt(longer / width) * F(-2.0f / 3.0f)), one);
  select(is_wide, ux, uy).store(out.du + i), select(is_wide, vx, vy).store(out.dv + i);
  count.store(out.count + i);
  (F(0.5f) * coarse_log2(width)).store(out.lod + i);
}

/// The probes of all fragments. Groups whose footprints repeat have those of the fragment before them.
template <class F, class View>
[[gnu::always_inline]] inline void compute_all_probes(const View& t, int anisotropy, const Footprint at, int count,
                                                      Probes& out) {
  for (int i = 0; i < count; i += F::lanes) compute_probes<F>(t, anisotropy, at, i, out);
  for (int i = 8; at.repeats != nullptr && i < count; i += 8)
    if (at.repeats[i / 8])
      for (float* const of : {out.du, out.dv, out.count, out.lod}) std::copy_n(of + i - 8, 8, of + i);
}

/// The greatest number of probes of the eight fragments from i on.
template <class F>
[[gnu::always_inline]] inline int max_probes(const Probes& probes, int i) {
  F n = F::load(probes.count + i);
  for (int k = F::lanes; k < 8; k += F::lanes) n = max(n, F::load(probes.count + i + k));
  return static_cast<int>(greatest(n));
}

/// One probe of each of eight fragments: as Taps, by level.
struct ProbeTaps {
  alignas(64) std::int32_t upper[2][8];
  alignas(64) std::int16_t bilinear_weight[2][16];  ///< in the order of by_fours
  alignas(64) std::int32_t lower[2][8];             ///< unset where ProbeGroup::has_pitch
  /// Weight of the probe in the mean of it and the fragment's probes before it, stored twice, in the order of by_fours;
  /// undefined for first probes.
  alignas(32) std::int16_t mean_weight[16];
};

/// The probes of eight fragments. Probe n of all fragments comes before probe n + 1; every fragment has as many entries
/// as the fragment with the most probes.
struct ProbeGroup {
  int probes;
  bool has_second;  ///< false: no fragment reads the second level, whose taps are unset
  bool has_pitch;   ///< of each level, all lower texels lie as many texels after the upper ones
  std::int32_t pitch[2];
  alignas(32) std::int16_t mip_weight[16];  ///< stored twice, in the order of by_fours
};

/// The weight of probe n in the mean of it and the n probes before it, in 1/32768.
struct MeanWeights {
  std::int16_t of[SamplerState::max_anisotropy] = {};
  constexpr MeanWeights() {
    for (int n = 1; n < SamplerState::max_anisotropy; ++n)
      of[n] = static_cast<std::int16_t>((32768 + (n + 1) / 2) / (n + 1));
  }
};
inline constexpr MeanWeights mean_weights;

/// The probes of several groups of fragments.
struct ProbeList {
  static constexpr int capacity = Taps::capacity / 8;
  static_assert(capacity >= SamplerState::max_anisotropy);
  ProbeTaps taps[capacity];
  ProbeGroup group[capacity];
  int count = 0;            ///< of taps
  int first = 0, last = 0;  ///< the range of fragments
};

/// The levels that fragments read, also both levels in one vector where Joined has such vectors.
template <class F, class Joined>
struct ProbeLevels {
  Lookup<F> lookup;
  MipLevel<typename Joined::Float> both;
};

template <class F, class Joined>
[[gnu::always_inline]] inline void join_levels(ProbeLevels<F, Joined>& levels) {
  if constexpr (Joined::exists) {
    const MipLevel<F>&a = levels.lookup.level[0], &b = levels.lookup.level[1];
    levels.both = {Joined::join(a.width, b.width), Joined::join(a.height, b.height), Joined::join(a.columns, b.columns),
                   Joined::join(a.rows, b.rows),   Joined::join(a.pitch, b.pitch),   Joined::join(a.offset, b.offset)};
  }
}

/// No vectors with twice the lanes of F.
template <class F>
struct NotJoined {
  static constexpr bool exists = false;
  using Float = F;
};

/// Stores taps of level `which`, or of both levels.
template <class F>
[[gnu::always_inline]] inline void store_probe_level(const TapsOfLevel<F>& taps, bool has_pitch, int which, int k,
                                                     ProbeTaps& out) {
  taps.upper.store(out.upper[which] + k);
  taps.right.store_by_fours(taps.down, out.bilinear_weight[which], k);
  if (!has_pitch) taps.lower.store(out.lower[which] + k);
}

/// Stores the taps of probes at (u, v).
template <class F, class Joined, class Filter>
[[gnu::always_inline]] inline void store_probe(const Filter& f, const ProbeLevels<F, Joined>& levels,
                                               const ProbeGroup& group, F u, F v, int k, ProbeTaps& out) {
  const WrappedCoordinates<F> p{wrap(u, f.mirror_u, f.clamp_u), wrap(v, f.mirror_v, f.clamp_v),
                                levels.lookup.is_nearest};
  if constexpr (Joined::exists) {
    if (group.has_second && !may_be_nearest(f)) {
      using Both = typename Joined::Float;
      const WrappedCoordinates<Both> both{Joined::join(p.u, p.u), Joined::join(p.v, p.v), {}};
      return store_probe_level(taps_of_level<Both>(f, both, levels.both), group.has_pitch, 0, 0, out);
    }
  }
  store_probe_level(taps_of_level<F>(f, p, levels.lookup.level[0]), group.has_pitch, 0, k, out);
  if (!group.has_second) return;
  store_probe_level(taps_of_level<F>(f, p, levels.lookup.level[1]), group.has_pitch, 1, k, out);
}

/// Stores the taps of the probes of the eight fragments from i on, and prefetches each probe's texels at the ends and
/// in the middle of the fragments, which mostly are a row.
template <class F, class Joined, class Address, class View, class Filter>
[[gnu::always_inline]] inline void store_probes(const Address& address, const View& t, const Filter& f,
                                                const Footprint& at, const Probes& probes, int i, int most,
                                                ProbeLevels<F, Joined> (&levels)[8 / F::lanes], ProbeGroup& group,
                                                ProbeTaps* out) {
  using Int = typename F::Int;
  bool has_second = false, has_pitch = !may_be_nearest(f) && !f.mirror_v && !f.clamp_v;
  for (int k = 0; k < 8; k += F::lanes) {
    Lookup<F>& lookup = levels[k / F::lanes].lookup;
    if (find_lookup<F>(t, f, F::load(probes.lod + i + k), lookup)) join_levels(levels[k / F::lanes]);
    lookup.mip_weight.store_by_fours(lookup.mip_weight, group.mip_weight, k);
    has_second = has_second || !none(lookup.mip_weight > Int(0));
    has_pitch = has_pitch && lookup.is_uniform && lookup.first.first() == levels[0].lookup.first.first();
  }
  group.probes = most, group.has_second = has_second, group.has_pitch = has_pitch;
  for (int which = 0; which < 2; ++which) group.pitch[which] = levels[0].lookup.pitch[which];

  const F one(1.0f), half(0.5f);
  for (int k = 0; k < 8; k += F::lanes) {
    const ProbeLevels<F, Joined>& of = levels[k / F::lanes];
    const F u = F::load(at.u + i + k), v = F::load(at.v + i + k);
    if (most == 1) {
      store_probe<F>(f, of, group, u, v, k, out[0]);
      continue;
    }
    // The offset of a fragment's only probe is 0, but its product with an infinite derivative is not.
    const F all = F::load(probes.count + i + k), step = one / all, first = half * step - half, last = all - one;
    const F du = F::load(probes.du + i + k), dv = F::load(probes.dv + i + k);
    const auto has_several = all > one;
    const F first_u = select(has_several, u + du * first, u), first_v = select(has_several, v + dv * first, v);
    store_probe<F>(f, of, group, first_u, first_v, k, out[0]);
    const F step_u = du * step, step_v = dv * step;
    for (int n = 1; n < most; ++n) {
      const F number(static_cast<float>(n)), along = min(number, last);
      store_probe<F>(f, of, group, first_u + step_u * along, first_v + step_v * along, k, out[n]);
      const Int weight = where(number < all, Int(mean_weights.of[n]));
      weight.store_by_fours(weight, out[n].mean_weight, k);
    }
  }
  for (int n = 0; n < most; ++n)
    for (int which = 0; which < (group.has_second ? 2 : 1); ++which) {
      const std::ptrdiff_t below = address.bytes(group.pitch[which]);
      for (const int k : {0, 4, 7}) {
        const unsigned char* const upper = address.at(out[n].upper[which][k]);
        prefetch(upper), prefetch(upper + below);
      }
    }
}

/// Finds the probes of all fragments, `most` by group, and calls mix(list) for as many at a time as a list has.
template <class F, class Joined, class Address, class View, class Filter, class Mix>
[[gnu::always_inline]] inline void mix_all_probes(const Address address, const View& t, const Filter& f,
                                                  const Footprint at, const Probes& probes, const int* most, int count,
                                                  Mix mix) {
  ProbeList list;
  ProbeLevels<F, Joined> levels[8 / F::lanes];
  for (ProbeLevels<F, Joined>& of : levels) of.lookup = begin_lookup<F>(t, f), join_levels(of);
  while (list.last < count) {
    list.first = list.last, list.count = 0;
    for (; list.last < count && list.count + most[list.last / 8] <= ProbeList::capacity; list.last += 8) {
      const int i = list.last, n = most[i / 8];
      store_probes<F, Joined>(address, t, f, at, probes, i, n, levels, list.group[(i - list.first) / 8],
                              list.taps + list.count);
      list.count += n;
    }
    mix(list);
  }
}

/// mix(list) stores the means of the probes. F has at most eight lanes, `Wide` at most sixteen; Joined joins two
/// vectors of F to one, where an instruction set has such vectors.
template <class F, class Wide, class Joined, class View, class Mix>
[[gnu::always_inline]] inline void sample_anisotropic(const View& t, const SamplerState& f, const Footprint& at,
                                                      int count, Mix mix) {
  Probes probes;
  compute_all_probes<Wide>(t, f.anisotropy, at, count, probes);
  int most[Taps::groups];
  for (int i = 0; i < count; i += 8) most[i / 8] = max_probes<F>(probes, i);
  if (is_trilinear_repeat(f) && t.unorm8 != nullptr)
    return mix_all_probes<F, Joined>(TexelAddress<true>(t), t, TrilinearRepeat{}, at, probes, most, count, mix);
  const TexelAddress<false> address(t);
  if (is_trilinear_repeat(f))
    return mix_all_probes<F, Joined>(address, t, TrilinearRepeat{}, at, probes, most, count, mix);
  mix_all_probes<F, Joined>(address, t, f, at, probes, most, count, mix);
}

}  // namespace zoneplate
