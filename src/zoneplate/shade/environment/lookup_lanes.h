// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/environment/environment_view.h"

/// Look-ups in a prepared environment, over the lane types of math/lanes.h.
namespace zoneplate {

/// Where directions meet the cube: the face, and s and t in [-1, 1] (shade/environment/cube.h).
template <class F>
struct CubePlace {
  typename F::Int face;
  F s, t;
};

/// Edges     a vector that is zero or not a number has some place.
template <class F>
[[gnu::always_inline]] inline CubePlace<F> cube_place(Vector<F> d) {
  using Int = typename F::Int;
  const F ax = abs(d.x), ay = abs(d.y), az = abs(d.z), zero(0.0f);
  const F longest = max(max(ax, ay), az);
  const F inverse = F(1.0f) / max(longest, F(1e-30f));
  const auto is_x = ax >= longest, is_y = ay >= longest;
  const F along = select(is_x, d.x, select(is_y, d.y, d.z));
  const Int axis = select(is_x, Int(0), select(is_y, Int(2), Int(4)));
  const auto bounded = [](F x) { return min(max(x, F(-1.0f)), F(1.0f)); };
  return {axis + select(along < zero, Int(1), Int(0)), bounded(select(is_x, d.y, select(is_y, d.z, d.x)) * inverse),
          bounded(select(is_x, d.z, select(is_y, d.x, d.y)) * inverse)};
}

/// The bilinear mean of the four texels about places of a level each. Requires: levels in range.
template <class F>
[[gnu::always_inline]] inline Vector<F> cube_texels(const EnvironmentView& e, const CubePlace<F>& place,
                                                    typename F::Int level) {
  using Int = typename F::Int;
  const Int side = Int::look_up(e.side, level), pitch = side + Int(2);
  const F half = F::from(side) * F(0.5f);
  // The centre of the first texel inside the border is at 1.
  const F x = (place.s + F(1.0f)) * half + F(0.5f), y = (place.t + F(1.0f)) * half + F(0.5f);
  const Int column = truncate(x), row = truncate(y);
  const F right = x - F::from(column), down = y - F::from(row);
  const Int first = Int::look_up(e.offset, level) + (place.face * pitch + row) * pitch + column;

  alignas(64) std::int32_t index[F::lanes], below[F::lanes];
  (first * Int(4)).store(index), ((first + pitch) * Int(4)).store(below);
  F texel[4][4];
  F::load_quads([&](int lane) { return e.texels + index[lane]; }, texel[0]);
  F::load_quads([&](int lane) { return e.texels + index[lane] + 4; }, texel[1]);
  F::load_quads([&](int lane) { return e.texels + below[lane]; }, texel[2]);
  F::load_quads([&](int lane) { return e.texels + below[lane] + 4; }, texel[3]);
  const auto mean = [&](int c) {
    const F above = texel[0][c] + (texel[1][c] - texel[0][c]) * right;
    const F under = texel[2][c] + (texel[3][c] - texel[2][c]) * right;
    return above + (under - above) * down;
  };
  return {mean(0), mean(1), mean(2)};
}

/// The direction in the environment's image of a direction in the world.
template <class F>
[[gnu::always_inline]] inline Vector<F> in_image(const EnvironmentView& e, Vector<F> d) {
  const float* m = e.image_from_world;
  return {F(m[0]) * d.x + F(m[1]) * d.y + F(m[2]) * d.z, F(m[3]) * d.x + F(m[4]) * d.y + F(m[5]) * d.z,
          F(m[6]) * d.x + F(m[7]) * d.y + F(m[8]) * d.z};
}

/// The light of the environment from about directions of any length, filtered by the lobe of GGX of a roughness in
/// [0, 1].
template <class F>
[[gnu::always_inline]] inline Vector<F> specular_light(const EnvironmentView& e, Vector<F> direction, F roughness) {
  using Int = typename F::Int;
  const CubePlace<F> place = cube_place(in_image(e, direction));
  const F level = e.level(min(max(roughness, F(0.0f)), F(1.0f)));
  const Int lower = min(truncate(level), Int(e.levels - 2));
  const F part = level - F::from(lower);
  const Vector<F> sharp = cube_texels(e, place, lower), blurred = cube_texels(e, place, lower + Int(1));
  return (sharp + (blurred - sharp) * part) * Vector<F>::all(e.tint);
}

/// The irradiance of surfaces with these normals, over π: what a white diffuse surface reflects.
template <class F>
[[gnu::always_inline]] inline Vector<F> diffuse_light(const EnvironmentView& e, Vector<F> normal) {
  const CubePlace<F> place = cube_place(in_image(e, normal));
  return cube_texels(e, place, typename F::Int(e.levels - 1)) * Vector<F>::all(e.tint);
}

namespace stages {

/// See LookupKernels.
template <class F>
void specular_lights(const EnvironmentView& e, const float* const direction[3], float roughness, float* const light[3],
                     int count) {
  for (int i = 0; i < count; i += F::lanes)
    specular_light(e, Vector<F>::load(direction, i), F(roughness)).store(light, i);
}

}  // namespace stages
}  // namespace zoneplate
