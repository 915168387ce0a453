// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/ray/bvh_build.h"

/// BuildKernels over the lane types of math/lanes.h: `F` for boxes and bins, `G` for coordinates.
namespace zoneplate::stages {

namespace build {

/// A BuildBox in registers.
template <class F>
struct LaneBox {
  static constexpr int parts = BuildBox::lanes / F::lanes;
  F part[parts];

  static LaneBox load(const BuildBox& box) {
    LaneBox out;
    for (int i = 0; i < parts; ++i) out.part[i] = F::load(box.v + i * F::lanes);
    return out;
  }
  void store(BuildBox& box) const {
    for (int i = 0; i < parts; ++i) part[i].store(box.v + i * F::lanes);
  }
  void add(const LaneBox& b) {
    for (int i = 0; i < parts; ++i) part[i] = min(b.part[i], part[i]);
  }
};

/// What the sides of the divisions before each bin have along one axis.
struct Sides {
  static constexpr std::size_t capacity = BuildBins::capacity;
  BuildBox box[capacity];
  float extent[capacity][4];
  std::int32_t count[capacity];

  template <class F, class G>
  [[gnu::always_inline]] void set(std::size_t bin, const LaneBox<F>& all, std::int32_t references) {
    all.store(box[bin]);
    for (int i = 0; i < 4; i += G::lanes)
      (-(G::load(box[bin].v + BuildBox::negated + i) + G::load(box[bin].v + i))).store(extent[bin] + i);
    count[bin] = references;
  }
  /// Half of the surface area times the blocks of triangles, which are tested four at a time.
  template <class F>
  [[gnu::always_inline]] F cost(std::size_t bin) const {
    using Int = typename F::Int;
    F side[4];
    F::load_fours(extent[bin], side);
    const Int blocks = (Int::load(count + bin) + Int(BvhLeaf::width - 1)).template shifted_right<2>();
    return (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]) * F::from(blocks);
  }
};
static_assert(BvhLeaf::width == 4);

}  // namespace build

template <class F, class G>
[[gnu::flatten]] BuildSplit split(const BuildReference* references, std::size_t n, const BuildBins& bins) {
  using namespace build;
  using Box = LaneBox<F>;
  constexpr std::size_t capacity = BuildBins::capacity;
  BuildBox box[3][capacity];
  std::int32_t count[3][capacity];
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < bins.count; ++b) box[a][b] = BuildBox::empty(), count[a][b] = 0;
  const G last(static_cast<float>(bins.count - 1));
  for (std::size_t i = 0; i < n; ++i) {
    const BuildBox& of = references[i].box;
    std::int32_t bin[4];
    for (int k = 0; k < 4; k += G::lanes) {
      const G centre = G::load(of.v + k) - G::load(of.v + BuildBox::negated + k);
      truncate(min((centre - G::load(bins.first + k)) * G::load(bins.scale + k), last)).store(bin + k);
    }
    const Box added = Box::load(of);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto b = static_cast<std::size_t>(bin[a]);
      ++count[a][b];
      Box all = Box::load(box[a][b]);
      all.add(added), all.store(box[a][b]);
    }
  }

  BuildSplit best;
  const auto all = static_cast<std::int32_t>(n);
  for (int a = 0; a < 3; ++a) {
    if (!(bins.scale[a] > 0)) continue;
    Sides left, right;
    Box on_left = Box::load(box[a][0]), on_right = Box::load(box[a][bins.count - 1]);
    std::int32_t left_count = count[a][0], right_count = count[a][bins.count - 1];
    for (std::size_t b = 1; b < bins.count; ++b) {
      const std::size_t of_right = bins.count - b;
      left.set<F, G>(b, on_left, left_count), right.set<F, G>(of_right, on_right, right_count);
      on_left.add(Box::load(box[a][b])), left_count += count[a][b];
      on_right.add(Box::load(box[a][of_right - 1])), right_count += count[a][of_right - 1];
    }
    left.set<F, G>(0, on_left, all), right.set<F, G>(0, on_left, all);
    // Bins beyond the last one are computed with it, and like bin 0 not looked at.
    for (std::size_t b = bins.count; b % static_cast<std::size_t>(F::lanes) != 0; ++b)
      left.set<F, G>(b, on_left, all), right.set<F, G>(b, on_left, all);
    float cost[capacity];
    for (std::size_t b = 0; b < bins.count; b += F::lanes) (left.cost<F>(b) + right.cost<F>(b)).store(cost + b);
    for (std::size_t b = 1; b < bins.count; ++b) {
      if (left.count[b] == 0 || left.count[b] == all || !(cost[b] < best.cost)) continue;
      best = {a, static_cast<std::int32_t>(b), cost[b], left.box[b], right.box[b]};
    }
  }
  return best;
}

template <class F, class G>
[[gnu::flatten]] std::size_t refer(const ShadowCaster& caster, std::uint32_t number, std::size_t begin, std::size_t end,
                                   BuildReference* out, BuildBounds& bounds) {
  using namespace build;
  constexpr int parts = 4 / G::lanes;
  G column[4][parts], box_low[parts], box_high[parts], centres_low[parts], centres_high[parts];
  const auto& columns = caster.world_from_object.column;
  for (int k = 0; k < parts; ++k) {
    const int lane = k * G::lanes;
    for (std::size_t c = 0; c < 4; ++c) {
      const float values[] = {columns[c].x, columns[c].y, columns[c].z, columns[c].w};
      column[c][k] = G::load(values + lane);
    }
    box_low[k] = G::load(bounds.box.v + lane), box_high[k] = G::load(bounds.box.v + BuildBox::negated + lane);
    centres_low[k] = G::load(bounds.centres.v + lane);
    centres_high[k] = G::load(bounds.centres.v + BuildBox::negated + lane);
  }
  BuildReference* at = out;
  for (std::size_t t = begin; t < end; ++t) {
    bool is_finite = true;
    for (int k = 0; k < parts; ++k) {
      G low, high, sum(0.0f);
      for (std::size_t i = 0; i < 3; ++i) {
        const float3& p = caster.position[caster.index[3 * t + i]];
        // The order of transform_point.
        const G v = column[0][k] * G(p.x) + column[1][k] * G(p.y) + column[2][k] * G(p.z) + column[3][k];
        low = i == 0 ? v : min(v, low), high = i == 0 ? v : max(v, high);
        sum = sum + v * G(0.0f);  // NaN unless it is finite
      }
      const unsigned finite = bits_of(sum == G(0.0f));
      const unsigned needed = 7u >> k * G::lanes & ((1u << G::lanes) - 1);  // x, y and z
      is_finite = is_finite && (finite & needed) == needed;
      low.store(at->box.v + k * G::lanes), (-high).store(at->box.v + BuildBox::negated + k * G::lanes);
    }
    if (!is_finite) continue;
    for (int k = 0; k < parts; ++k) {
      const G low = G::load(at->box.v + k * G::lanes), high = G::load(at->box.v + BuildBox::negated + k * G::lanes);
      const G centre = low - high;
      box_low[k] = min(low, box_low[k]), box_high[k] = min(high, box_high[k]);
      centres_low[k] = min(centre, centres_low[k]), centres_high[k] = min(-centre, centres_high[k]);
    }
    at->set(number, static_cast<std::uint32_t>(t));
    ++at;
  }
  for (int k = 0; k < parts; ++k) {
    const int lane = k * G::lanes;
    box_low[k].store(bounds.box.v + lane), box_high[k].store(bounds.box.v + BuildBox::negated + lane);
    centres_low[k].store(bounds.centres.v + lane);
    centres_high[k].store(bounds.centres.v + BuildBox::negated + lane);
  }
  return static_cast<std::size_t>(at - out);
}

template <class F, class G>
constexpr BuildKernels build_kernels() {
  return {.refer = &refer<F, G>, .split = &split<F, G>};
}

}  // namespace zoneplate::stages
