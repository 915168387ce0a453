// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/shade/shadow/hemisphere_light.h"

/// The kernels of shade/shadow/hemisphere_light.h over the lane types of math/lanes.h.
namespace zoneplate::stages {

/// Component c of a vector about +z, turned to a frame.
template <class F>
[[gnu::always_inline]] inline F turned(const float3 (&frame)[3], float float3::*c, F x, F y, F z) {
  return F(frame[0].*c) * x + F(frame[1].*c) * y + F(frame[2].*c) * z;
}

/// The number of the cell in which a direction meets the square onto which the octahedron is unfolded. Edges: of no
/// number, the last one.
template <class F>
[[gnu::always_inline]] inline typename F::Int folded(F x, F y, F z) {
  using Int = typename F::Int;
  constexpr float scale = 0.5f * HemisphereKernels::side;
  const F inverse = F(1.0f) / (abs(x) + abs(y) + abs(z));
  const F fold = max(-z * inverse, F(0.0f));
  const auto index = [&](F s) {
    const F signed_fold = select(as_int(s) < Int(0), -fold, fold);
    return truncate(min((s + signed_fold + F(1.0f)) * F(scale), F(2 * scale - 1)));
  };
  return index(y * inverse) * Int(HemisphereKernels::side) + index(x * inverse);
}

template <class F>
void look_up(const float* octahedron, const float (&middle)[3][HemisphereCells::count], const float3 (&frame)[3],
             HemisphereLight& out) {
  constexpr int rings = HemisphereCells::rings;
  for (int r = 0; r < rings; r += F::lanes) {
    F sum(0.0f);
    for (int c = r; c < HemisphereCells::count; c += rings) {
      const F x = F::load(middle[0] + c), y = F::load(middle[1] + c), z = F::load(middle[2] + c);
      const F light =
          F::gather(octahedron, folded(turned(frame, &float3::x, x, y, z), turned(frame, &float3::y, x, y, z),
                                       turned(frame, &float3::z, x, y, z)));
      as_int(light).store(out.light + c);
      sum = sum + light;
    }
    sum.store(out.sum + r);
  }
}

template <class F>
void directions(const HemisphereLight& light, const HemispherePlaces& places, const float3 (&frame)[3],
                float (&direction)[3][HemispherePlaces::capacity]) {
  using Int = typename F::Int;
  constexpr int rings = HemisphereCells::rings, sectors = HemisphereCells::sectors;
  constexpr float whole_turn = 6.28318531f;
  const F zero(0.0f), one(1.0f), half(0.5f);
  for (int i = 0; i < places.count; i += F::lanes) {
    const Int ring = Int::load(places.ring + i);
    const auto of_rings = [&](const auto* table) { return Int::look_up(table, ring); };
    const F sum = F::gather(light.sum, ring), part = F::load(places.across + i) / sum;
    // By rounding, the last of the targets may lie behind the last ring with light.
    const F across = select(sum > zero, select(part < zero, zero, select(one < part, one, part)), half);
    F along = F::load(places.turn + i) * sum, here = F::of_bits(of_rings(light.light));
    Int sector(0);
    for (int s = 1; s < sectors; ++s) {
      const auto is_beyond = (along >= here) & (sector == Int(s - 1));
      if (none(is_beyond)) break;
      along = select(is_beyond, along - here, along), sector = sector + where(is_beyond, Int(1));
      here = select(is_beyond, F::of_bits(of_rings(light.light + s * rings)), here);
    }
    const F within = select(here > zero, min(along / here, one), half);
    const F square = min((F::from(ring) + across) / F(static_cast<float>(rings)), one);
    const F turn = F(whole_turn) * ((F::from(sector) + within) / F(static_cast<float>(sectors)));
    const F sine = sqrt(square), x = sine * cos(turn), y = sine * sin(turn), z = sqrt(one - square);
    turned(frame, &float3::x, x, y, z).store(direction[0] + i);
    turned(frame, &float3::y, x, y, z).store(direction[1] + i);
    turned(frame, &float3::z, x, y, z).store(direction[2] + i);
  }
}

template <class F>
constexpr HemisphereKernels hemisphere_kernels() {
  return {.look_up = &look_up<F>, .directions = &directions<F>};
}

}  // namespace zoneplate::stages
