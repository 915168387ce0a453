// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// Where places lie between the control points of a level of which every face has `side` texels.
template <class F>
struct SplineCells {
  typename F::Int first;  ///< the first of nine control points, counted in the level
  typename F::Int pitch;  ///< control points from one row to the next
  SplineWeights<F> across, down;
};
template <class F>
[[gnu::always_inline]] inline SplineCells<F> spline_cells(const CubePlace<F>& place, typename F::Int side) {
  using Int = typename F::Int;
  const Int pitch = side + Int(2);
  const F half = F::from(side) * F(0.5f);
  const F x = (place.s + F(1.0f)) * half, y = (place.t + F(1.0f)) * half;
  const Int column = min(truncate(x), side - Int(1)), row = min(truncate(y), side - Int(1));
  return {(place.face * pitch + row) * pitch + column, pitch, spline_weights(x - F::from(column) - F(0.5f)),
          spline_weights(y - F::from(row) - F(0.5f))};
}

/// The control points of one level.
template <class F>
struct LevelPoints {
  /// The control point at `texel`, for all lanes; it is in the level of the given lane.
  [[gnu::always_inline]] Vector<F> at(const float* texel, int /*lane*/) const {
    return {F(texel[0]), F(texel[1]), F(texel[2])};
  }
  /// Those at texel(0), texel(1) ... for the lanes from `first` on.
  template <class Texel>
  [[gnu::always_inline]] typename F::Four::Quads at_lanes(const Texel& texel, int /*first*/) const {
    return F::Four::Quads::load(texel);
  }
};

/// The control points of a level mixed with those of the levels before and after it, of the same size.
template <class F>
struct MixedPoints {
  using Four = typename F::Four;
  using Quads = typename Four::Quads;
  SplineWeights<F> weights;                     ///< of the level before, the level and the level after
  alignas(64) std::int32_t distance[F::lanes];  ///< from one level to the next, in floats
  alignas(64) float weight[3][F::lanes];

  [[gnu::always_inline]] MixedPoints(const SplineWeights<F>& of, typename F::Int between) : weights(of) {
    between.store(distance);
    for (int k = 0; k < 3; ++k) of.of[k].store(weight[k]);
  }
  [[gnu::always_inline]] Vector<F> at(const float* texel, int lane) const {
    const float* const before = texel - distance[lane];
    const float* const after = texel + distance[lane];
    const auto mixed = [&](int c) __attribute__((always_inline)) {
      return F(texel[c]) * weights.of[1] + F(before[c]) * weights.of[0] + F(after[c]) * weights.of[2];
    };
    return {mixed(0), mixed(1), mixed(2)};
  }
  template <class Texel>
  [[gnu::always_inline]] Quads at_lanes(const Texel& texel, int first) const {
    const auto before = [&](int lane) { return texel(lane) - distance[first + lane]; };
    const auto after = [&](int lane) { return texel(lane) + distance[first + lane]; };
    return Quads::load(texel) * Four::load(weight[1] + first) + Quads::load(before) * Four::load(weight[0] + first) +
           Quads::load(after) * Four::load(weight[2] + first);
  }
};

/// The spline over the nine control points from `texel` on, in rows of `step` floats, where they are those of `lane`.
template <class F, class Points>
[[gnu::always_inline]] inline Vector<F> light_in_cell(const Points& points, const float* texel, std::int32_t step,
                                                      const SplineWeights<F>& across, const SplineWeights<F>& down,
                                                      int lane) {
  const auto in_row = [&](const float* t) __attribute__((always_inline)) {
    return points.at(t, lane) * across.of[0] + points.at(t + 3, lane) * across.of[1] +
           points.at(t + 6, lane) * across.of[2];
  };
  return in_row(texel) * down.of[0] + in_row(texel + step) * down.of[1] + in_row(texel + 2 * step) * down.of[2];
}

/// The same where every lane has its own first control point and step, four lanes at a time.
template <class F, class Points>
[[gnu::noinline]] Vector<F> light_in_cells(const Points& points, const float* texels, const std::int32_t* offset,
                                           const std::int32_t* step, const SplineWeights<F>& across,
                                           const SplineWeights<F>& down) {
  using Four = typename F::Four;
  alignas(64) float across_of[3][F::lanes], down_of[3][F::lanes], light[3][F::lanes];
  for (int k = 0; k < 3; ++k) across.of[k].store(across_of[k]), down.of[k].store(down_of[k]);
  for (int first = 0; first < F::lanes; first += Four::lanes) {
    const float* texel[Four::lanes];
    std::ptrdiff_t row[Four::lanes];
    for (int lane = 0; lane < Four::lanes; ++lane)
      texel[lane] = texels + offset[first + lane], row[lane] = step[first + lane];
    const auto in_row = [&](int r) __attribute__((always_inline)) {
      const auto at = [&](int c) __attribute__((always_inline)) {
        const auto texel_of = [&](int lane) { return texel[lane] + r * row[lane] + 3 * c; };
        return points.at_lanes(texel_of, first) * Four::load(across_of[c] + first);
      };
      return (at(0) + at(1) + at(2)) * Four::load(down_of[r] + first);
    };
    Four sum[4];
    (in_row(0) + in_row(1) + in_row(2)).split(sum);
    for (int c = 0; c < 3; ++c) sum[c].store(light[c] + first);
  }
  return Vector<F>::load(light, 0);
}

/// The spline over the control points in cells, the first of which are at `texels` + `offset`.
///
/// Neighbouring fragments are often in one cell of the spline, or in two or three, whose control points are loaded
/// once.
template <class F, class Points>
[[gnu::always_inline]] inline Vector<F> light_at(const Points& points, const float* texels, typename F::Int offset,
                                                 const SplineCells<F>& cells) {
  using Int = typename F::Int;
  alignas(64) std::int32_t offsets[F::lanes], step[F::lanes];
  offset.store(offsets), (cells.pitch * Int(3)).store(step);
  const auto is_in = [&](int lane) { return offset == Int(offsets[lane]); };
  const auto in_cell_of = [&](int lane) __attribute__((always_inline)) {
    return light_in_cell<F>(points, texels + offsets[lane], step[lane], cells.across, cells.down, lane);
  };
  constexpr int middle = F::lanes / 2, last = F::lanes - 1;
  const auto in_first = is_in(0);
  if (all(in_first)) return in_cell_of(0);
  const auto in_last = is_in(last);
  if (all(in_first | in_last)) return select(in_first, in_cell_of(0), in_cell_of(last));
  if (all(in_first | in_last | is_in(middle)))
    return select(in_first, in_cell_of(0), select(in_last, in_cell_of(last), in_cell_of(middle)));
  return light_in_cells<F>(points, texels, offsets, step, cells.across, cells.down);
}

/// The spline of a level each at places.
template <class F>
[[gnu::always_inline]] inline Vector<F> cube_light(const EnvironmentView& e, const CubePlace<F>& place,
                                                   typename F::Int level) {
  using Int = typename F::Int;
  const SplineCells<F> cells = spline_cells(place, Int::gather(e.side, level));
  return light_at<F>(LevelPoints<F>(), e.texels, (Int::gather(e.offset, level) + cells.first) * Int(3), cells);
}

/// The levels of a roughness in [0, 1]: `middle` and its neighbours.
template <class F>
struct LevelWeights {
  typename F::Int middle;
  SplineWeights<F> weights;
};
template <class F>
[[gnu::always_inline]] inline LevelWeights<F> level_weights(const EnvironmentView& e, F roughness) {
  using Int = typename F::Int;
  const F level = e.level(min(max(roughness, F(0.0f)), F(1.0f)));
  const Int middle = min(max(truncate(level + F(0.5f)), Int(1)), Int(e.levels - 2));
  return {middle, spline_weights(level - F::from(middle))};
}

/// The direction in the environment's image of a direction in the world.
template <class F>
[[gnu::always_inline]] inline Vector<F> in_image(const EnvironmentView& e, Vector<F> d) {
  const float* m = e.image_from_world;
  return {F(m[0]) * d.x + F(m[1]) * d.y + F(m[2]) * d.z, F(m[3]) * d.x + F(m[4]) * d.y + F(m[5]) * d.z,
          F(m[6]) * d.x + F(m[7]) * d.y + F(m[8]) * d.z};
}

/// The spline of three levels at places, where the faces of the levels differ in size.
template <class F>
[[gnu::noinline]] Vector<F> light_of_levels(const EnvironmentView& e, const CubePlace<F>& place,
                                            const LevelWeights<F>& levels) {
  using Int = typename F::Int;
  const SplineWeights<F>& weights = levels.weights;
  Vector<F> sum = cube_light(e, place, levels.middle) * weights.of[1];
  sum = sum + cube_light(e, place, levels.middle - Int(1)) * weights.of[0];
  return sum + cube_light(e, place, levels.middle + Int(1)) * weights.of[2];
}

/// The same where their faces have `side` texels: the control points are mixed first, as those of a MixedLevel are.
template <class F>
[[gnu::always_inline]] inline Vector<F> light_of_equal_levels(const EnvironmentView& e, const CubePlace<F>& place,
                                                              const LevelWeights<F>& levels, typename F::Int side) {
  using Int = typename F::Int;
  const SplineCells<F> cells = spline_cells(place, side);
  const MixedPoints<F> points(levels.weights, cells.pitch * cells.pitch * Int(3 * EnvironmentView::faces));
  return light_at<F>(points, e.texels, (Int::gather(e.offset, levels.middle) + cells.first) * Int(3), cells);
}

/// Radiance as a view adds it up from a spline: not negative, and tinted.
template <class F>
[[gnu::always_inline]] inline Vector<F> tinted(const EnvironmentView& e, Vector<F> light) {
  const auto bounded = [](F x) { return max(x, F(0.0f)); };
  return Vector<F>{bounded(light.x), bounded(light.y), bounded(light.z)} * Vector<F>::all(e.tint);
}

/// The light of the environment from about directions of any length, filtered by the lobe of GGX of a roughness in
/// [0, 1].
template <class F>
[[gnu::always_inline]] inline Vector<F> specular_light(const EnvironmentView& e, Vector<F> direction, F roughness) {
  using Int = typename F::Int;
  const CubePlace<F> place = cube_place(in_image(e, direction));
  const LevelWeights<F> levels = level_weights(e, roughness);
  const Int side = Int::gather(e.common_side, levels.middle);
  const auto has_equal = side > Int(0);
  Vector<F> sum{F(0.0f), F(0.0f), F(0.0f)};
  if (!none(has_equal)) sum = light_of_equal_levels(e, place, levels, max(side, Int(1)));
  if (!all(has_equal)) sum = select(has_equal, sum, light_of_levels(e, place, levels));
  return tinted(e, sum);
}

/// The same for the roughness of a mixed level: the same bits.
template <class F>
[[gnu::always_inline]] inline Vector<F> specular_light(const EnvironmentView& e, const MixedLevel& level,
                                                       Vector<F> direction) {
  using Int = typename F::Int;
  const SplineCells<F> cells = spline_cells(cube_place(in_image(e, direction)), Int(level.side));
  return tinted(e, light_at<F>(LevelPoints<F>(), level.texels, cells.first * Int(3), cells));
}

/// The irradiance of surfaces with these normals, over π: what a white diffuse surface reflects.
template <class F>
[[gnu::always_inline]] inline Vector<F> diffuse_light(const EnvironmentView& e, Vector<F> normal) {
  using Int = typename F::Int;
  const SplineCells<F> cells = spline_cells(cube_place(in_image(e, normal)), Int(e.side[e.levels]));
  const float* const texels = e.texels + 3 * e.offset[e.levels];
  return light_at<F>(LevelPoints<F>(), texels, cells.first * Int(3), cells) * Vector<F>::all(e.tint);
}

namespace stages {

/// See LookupKernels.
template <class F>
void specular_lights(const EnvironmentView& e, const float* const direction[3], float roughness, float* const light[3],
                     int count) {
  for (int i = 0; i < count; i += F::lanes)
    specular_light(e, Vector<F>::load(direction, i), F(roughness)).store(light, i);
}

/// See LookupKernels.
template <class F>
void mix_levels(const float* const level[3], const float weights[3], float* mixed, int count) {
  for (int i = 0; i < count; i += F::lanes)
    (F::load(level[1] + i) * F(weights[1]) + F::load(level[0] + i) * F(weights[0]) +
     F::load(level[2] + i) * F(weights[2]))
        .store(mixed + i);
}

}  // namespace stages
}  // namespace zoneplate
