// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "zoneplate/shade/shadow/grid_fit.h"

/// The interpolation of shade/shadow/grid_fit.h over the lane types of math/lanes.h, whose lanes are receivers.
namespace zoneplate::stages {

/// Of the normals of points of one surface: 18 degrees. A hundred spheres have more error by 0.97 and by 0.9.
inline constexpr float min_cosine = 0.95f;
/// The greatest sine of the angle between the line of two points and the plane across the sum of their normals: this at
/// least, the sine of the angle between the normals, and those of the angles to their triangles' normals. It is 0 on a
/// circle. By 0.02 in place of 0.1 the RMS of ten scenes is the same, and the time up to 1.2 times as long.
inline constexpr float min_slope = 0.1f;
/// The sine of the slope from which on a point is above a surface, whose shadow may begin there. A pane 0.1 above a
/// floor (RMS to 1,024 rays, 320 × 240): 0.0037 by this value, 0.013 by 0.3, at which Suzanne takes 0.7 of the time.
inline constexpr float occluding_slope = 0.15f;
/// The farthest that such a point matters, relative to the farthest of the points on the surface, as the square.
inline constexpr float close = 4;
/// The least sum of the weights of the points on the surface; that of all is 1.
inline constexpr float min_weight = 0.3f;
/// The fewest such points, if there are others between them or not.
inline constexpr int min_points = 6, min_points_nearby = 5;
/// The greatest standard deviation of values from the fitted plane, besides their error.
inline constexpr float max_deviation = 0.03f;
/// Weight of a plane without slope, relative to that of the points: where these lie on a line, it decides across.
inline constexpr float flatness = 0.005f;

/// The cubic B-spline.
template <class F>
[[gnu::always_inline]] inline F spline(F t) {
  constexpr float sixth = 1 / 6.0f;
  const F d = abs(t), rest = max(F(2.0f) - d, F(0.0f));
  const F inner = F(4.0f) - F(6.0f) * d * d + F(3.0f) * d * d * d;
  return select(d < F(1.0f), inner, rest * rest * rest) * F(sixth);
}

/// Weighted moments of places (x, y) and values.
template <class F>
struct PlaneMoments {
  F one{0.0f}, x{0.0f}, y{0.0f}, xx{0.0f}, xy{0.0f}, yy{0.0f}, f{0.0f}, xf{0.0f}, yf{0.0f}, ff{0.0f};

  [[gnu::always_inline]] void add(F weight, F px, F py, F value) {
    const F wx = weight * px, wy = weight * py, wf = weight * value;
    one = one + weight, x = x + wx, y = y + wy;
    xx = xx + wx * px, xy = xy + wx * py, yy = yy + wy * py;
    f = f + wf, xf = xf + wx * value, yf = yf + wy * value, ff = ff + wf * value;
  }
};

/// The plane that fits the values best.
template <class F>
struct FittedPlane {
  F at_origin;
  F variance;  ///< of the values about it

  [[gnu::always_inline]] explicit FittedPlane(const PlaneMoments<F>& m) {
    const F mx = m.x / m.one, my = m.y / m.one, mf = m.f / m.one;
    const F xx = m.xx / m.one - mx * mx + F(flatness), yy = m.yy / m.one - my * my + F(flatness);
    const F xy = m.xy / m.one - mx * my;
    const F xf = m.xf / m.one - mx * mf, yf = m.yf / m.one - my * mf, ff = m.ff / m.one - mf * mf;
    const F determinant = xx * yy - xy * xy;
    const F along = (xf * yy - yf * xy) / determinant, down = (yf * xx - xf * xy) / determinant;
    at_origin = mf - along * mx - down * my, variance = max(ff - along * xf - down * yf, F(0.0f));
  }
};

template <class F>
void fit(const GridNeighbours& near, const GridReceivers& receivers, const GridDensity& density, float* visible) {
  using Int = typename F::Int;
  const F zero(0.0f), one(1.0f), none(GridNeighbours::nothing);
  for (int i = 0; i < receivers.count; i += F::lanes) {
    const F u = F::load(receivers.u + i), v = F::load(receivers.v + i);
    const Int surface = Int::load(receivers.surface + i);
    const F own_bend = F::load(receivers.bend + i) + F(min_slope * min_slope);
    F at[3], normal[3];
    for (int c = 0; c < 3; ++c)
      at[c] = F::load(receivers.position[c] + i), normal[c] = F::load(receivers.normal[c] + i);
    PlaneMoments<F> moments;
    F least = one, greatest = zero;
    F reach = zero, nearest_above(HUGE_VALF);  // squares of distances
    Int count(0);
    for (int k = 0; k < near.count; ++k) {
      const F across = F(near.x[k]) - u, down = F(near.y[k]) - v, value(near.visible[k]);
      const F weight = spline(across) * spline(down);
      const F a = normal[0], b = normal[1], c = normal[2];
      const F nx(near.normal[0][k]), ny(near.normal[1][k]), nz(near.normal[2][k]);
      const F x = F(near.position[0][k]) - at[0], y = F(near.position[1][k]) - at[1],
              z = F(near.position[2][k]) - at[2];
      const F cosine = nx * a + ny * b + nz * c;
      const F rise = x * (nx + a) + y * (ny + b) + z * (nz + c);
      const F steepest = F(4.0f) * (own_bend + F(near.bend[k]) + max(one - cosine * cosine, zero));
      const F distance = x * x + y * y + z * z, height = x * a + y * b + z * c;
      const auto has_weight = weight > zero;
      const auto is_of_surface =
          (surface == Int(near.surface[k])) & (cosine >= F(min_cosine)) & (steepest * distance >= rise * rise);
      const auto is_on_surface = has_weight & is_of_surface & (value >= zero);
      if (density.has_gaps && near.visible[k] != GridNeighbours::nothing) {
        const auto is_above =
            has_weight & (height > zero) & (height * height > F(occluding_slope * occluding_slope) * distance);
        nearest_above =
            select(is_of_surface, nearest_above, select(is_above, min(distance, nearest_above), nearest_above));
      }
      reach = select(is_on_surface, max(distance, reach), reach);
      count = count + where(is_on_surface, Int(1));
      least = select(is_on_surface, min(value, least), least);
      greatest = select(is_on_surface, max(value, greatest), greatest);
      moments.add(where(is_on_surface, weight), across, down, value);
    }
    const FittedPlane<F> plane(moments);
    const F clamped =
        select(plane.at_origin < least, least, select(greatest < plane.at_origin, greatest, plane.at_origin));
    const F error = plane.variance * F::from(count) / F::from(count - Int(3));
    const F allowed = F(max_deviation * max_deviation) + F(density.noise) * clamped * (one - clamped);
    const F fitted = select(least == greatest, least, select(allowed >= error, clamped, none));
    const auto is_known =
        (count > Int((density.has_gaps ? min_points : min_points_nearby) - 1)) & (moments.one >= F(min_weight));
    select(F(close) * reach >= nearest_above, none, select(is_known, fitted, none)).store(visible + i);
  }
}

}  // namespace zoneplate::stages
