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

/// The uniform quadratic B-spline: the weights of three control points for a point at `u` in [-1/2, 1/2] from the
/// second; beyond that, those of the same polynomials.
template <class F>
struct SplineWeights {
  F of[3];
};
template <class F>
[[gnu::always_inline]] inline SplineWeights<F> spline_weights(F u) {
  const F before = F(0.5f) - u, after = F(0.5f) + u;
  return {{before * before * F(0.5f), F(0.75f) - u * u, after * after * F(0.5f)}};
}

/// The spline over the nine control points from `texel` on, in rows of `step` floats.
template <class F>
[[gnu::always_inline]] inline Vector<F> light_in_cell(const float* texel, std::int32_t step,
                                                      const SplineWeights<F>& across, const SplineWeights<F>& down) {
  const auto in_row = [&](const float* t) {
    const auto at = [&](int c) { return Vector<F>{F(t[3 * c]), F(t[3 * c + 1]), F(t[3 * c + 2])} * across.of[c]; };
    return at(0) + at(1) + at(2);
  };
  return in_row(texel) * down.of[0] + in_row(texel + step) * down.of[1] + in_row(texel + 2 * step) * down.of[2];
}

/// The same where every lane has its own first control point and step.
template <class F>
[[gnu::always_inline]] inline Vector<F> light_in_cells(const float* texels, const std::int32_t* offset,
                                                       const std::int32_t* step, const SplineWeights<F>& across,
                                                       const SplineWeights<F>& down) {
  using Quads = typename F::Quads;
  alignas(64) const float* texel[F::lanes];
  for (int lane = 0; lane < F::lanes; ++lane) texel[lane] = texels + offset[lane];
  const auto in_row = [&] {
    const auto at = [&](int c) { return Quads::load([&](int lane) { return texel[lane] + 3 * c; }) * across.of[c]; };
    return at(0) + at(1) + at(2);
  };
  Quads sum = in_row() * down.of[0];
  for (int r = 1; r < 3; ++r) {
    for (int lane = 0; lane < F::lanes; ++lane) texel[lane] += step[lane];
    sum = sum + in_row() * down.of[r];
  }
  F light[4];
  sum.split(light);
  return {light[0], light[1], light[2]};
}

/// The spline of a level each at places.
///
/// Neighbouring fragments are often in one cell of the spline, or in two or three, whose control points are loaded
/// once.
template <class F>
[[gnu::always_inline]] inline Vector<F> cube_light(const EnvironmentView& e, const CubePlace<F>& place,
                                                   typename F::Int level) {
  using Int = typename F::Int;
  const Int side = Int::gather(e.side, level), pitch = side + Int(2);
  const F half = F::from(side) * F(0.5f);
  const F x = (place.s + F(1.0f)) * half, y = (place.t + F(1.0f)) * half;
  const Int column = min(truncate(x), side - Int(1)), row = min(truncate(y), side - Int(1));
  const auto across = spline_weights(x - F::from(column) - F(0.5f)), down = spline_weights(y - F::from(row) - F(0.5f));
  const Int first = (Int::gather(e.offset, level) + (place.face * pitch + row) * pitch + column) * Int(3);

  alignas(64) std::int32_t offset[F::lanes], step[F::lanes];
  first.store(offset), (pitch * Int(3)).store(step);
  const auto is_in = [&](int lane) { return first == Int(offset[lane]); };
  const auto in_cell_of = [&](int lane) { return light_in_cell<F>(e.texels + offset[lane], step[lane], across, down); };
  constexpr int middle = F::lanes / 2, last = F::lanes - 1;
  const auto in_first = is_in(0);
  if (all(in_first)) return in_cell_of(0);
  const auto in_last = is_in(last);
  if (all(in_first | in_last)) return select(in_first, in_cell_of(0), in_cell_of(last));
  if (all(in_first | in_last | is_in(middle)))
    return select(in_first, in_cell_of(0), select(in_last, in_cell_of(last), in_cell_of(middle)));
  return light_in_cells<F>(e.texels, offset, step, across, down);
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
  const Int middle = min(max(truncate(level + F(0.5f)), Int(1)), Int(e.levels - 2));
  const auto weights = spline_weights(level - F::from(middle));
  Vector<F> sum = cube_light(e, place, middle) * weights.of[1];
  sum = sum + cube_light(e, place, middle - Int(1)) * weights.of[0];
  sum = sum + cube_light(e, place, middle + Int(1)) * weights.of[2];
  const auto bounded = [](F x) { return max(x, F(0.0f)); };
  return Vector<F>{bounded(sum.x), bounded(sum.y), bounded(sum.z)} * Vector<F>::all(e.tint);
}

/// The irradiance of surfaces with these normals, over π: what a white diffuse surface reflects.
template <class F>
[[gnu::always_inline]] inline Vector<F> diffuse_light(const EnvironmentView& e, Vector<F> normal) {
  const CubePlace<F> place = cube_place(in_image(e, normal));
  return cube_light(e, place, typename F::Int(e.levels)) * Vector<F>::all(e.tint);
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
