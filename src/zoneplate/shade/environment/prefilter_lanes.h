// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "zoneplate/math/basis.h"
#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/environment/prefilter.h"

namespace zoneplate::stages {

/// The centre of a block's directions and the greatest distance of one from it, along chords of the unit sphere.
struct Cone {
  float3 centre;
  float radius;
};

[[gnu::always_inline]] inline Cone cone_of(const DirectionBlock& b) {
  const auto direction = [&](int i) { return float3{b.x[i], b.y[i], b.z[i]}; };
  float3 sum{0, 0, 0};
  for (int i = 0; i < DirectionBlock::size; ++i) sum = sum + direction(i);
  const float3 centre = normalize(sum);
  float square = 0;
  for (int i = 0; i < DirectionBlock::size; ++i) {
    const float3 away = direction(i) - centre;
    square = std::max(square, dot(away, away));
  }
  return {centre, std::sqrt(square)};
}

/// Where a node is: the centroid of its light with a basis, and that of its directions.
struct NodePlace {
  float3 of_light;
  Basis basis;
  float3 of_angle;

  [[gnu::always_inline]] explicit NodePlace(const LightTree::Node& node)
      : of_light{node.direction[0], node.direction[1], node.direction[2]},
        basis(of_light),
        of_angle(of_light + basis.first * node.centre[0] + basis.second * node.centre[1]) {}
};

/// Which nodes are divided.
struct Division {
  Cone cone;
  float detail, core, width_at_horizon;
  static constexpr float horizon = 1.41421356f;  ///< the chord of a right angle

  /// The narrowest lobe requires the smallest nodes. The wider a lobe, the more light arrives from near the horizon,
  /// where it ends abruptly.
  [[gnu::always_inline]] Division(const Lobes& lobes, const DirectionBlock& block)
      : cone(cone_of(block)),
        detail(lobes.detail),
        core(std::min(2 * lobes.alpha[0], 0.7f)),
        width_at_horizon(0.08f / lobes.alpha[lobes.count - 1]) {}

  /// Whether a node is skipped, taken whole or divided.
  struct Limits {
    bool is_below;    ///< the horizon of all directions: skipped
    bool is_whole;    ///< for all directions
    bool is_divided;  ///< for any
    float distance2;  ///< if neither, it is divided where a direction is nearer than this, by its square
  };

  [[gnu::always_inline]] Limits limits(const LightTree::Node& node, const NodePlace& place, float width) const {
    const float3 away = place.of_light - cone.centre, from_middle = place.of_angle - cone.centre;
    const float distance = std::sqrt(dot(away, away)) - cone.radius;
    const float nearer = std::min(distance, std::sqrt(dot(from_middle, from_middle)) - cone.radius);
    // A node is at most √2 widths long.
    const float above = horizon - (distance - 1.5f * width);
    const bool straddles = above < 3 * width + 2 * cone.radius;
    // The distance and the core that allow the width.
    const float least = width * node.fineness / detail;
    return {above < 0, least <= nearer || least <= core, straddles && width * node.prominence > width_at_horizon,
            least * least};
  }
};

/// The weighted sums of the directions of a block, for lobes and channels: three, or one of a tree without colour.
template <class F, int Channels>
struct LobeSums {
  static constexpr int vectors = DirectionBlock::size / F::lanes;
  Vector<F> direction[vectors];
  const int lobes;
  F light[Lobes::most][vectors][Channels], weight[Lobes::most][vectors], alpha2[Lobes::most];

  /// Of a node's second moments: the mean square along n, over 4, and the mean of |δ|² / 2.
  struct Moments {
    F xx, xy, yy, mean;
    explicit Moments(const LightTree::Squares& s)
        : xx(s.xx * 0.25f), xy(s.xy * 0.5f), yy(s.yy * 0.25f), mean((s.xx + s.yy) * 0.5f) {}
    F square(F along_xx, F along_xy, F along_yy) const { return xx * along_xx + xy * along_xy + yy * along_yy; }
  };

  LobeSums(const DirectionBlock& b, const Lobes& of) : lobes(of.count) {
    for (int k = 0; k < vectors; ++k)
      direction[k] = {F::load(b.x + k * F::lanes), F::load(b.y + k * F::lanes), F::load(b.z + k * F::lanes)};
    for (int a = 0; a < lobes; ++a) {
      alpha2[a] = F(of.alpha[a] * of.alpha[a]);
      for (int k = 0; k < vectors; ++k) {
        for (F& channel : light[a][k]) channel = F(0.0f);
        weight[a][k] = F(0.0f);
      }
    }
  }

  [[gnu::always_inline]] static Vector<F> broadcast(float3 v) { return {F(v.x), F(v.y), F(v.z)}; }

  /// True if a direction of the block is nearer to a node than this distance, by its square.
  [[gnu::always_inline]] bool is_near(const NodePlace& node, float square) const {
    const Vector<F> l = broadcast(node.of_light), middle = broadcast(node.of_angle);
    bool is_far = true;
    for (int k = 0; k < vectors; ++k) {
      const Vector<F> away = direction[k] - l, from_middle = direction[k] - middle;
      is_far = is_far && all(min(dot(away, away), dot(from_middle, from_middle)) >= F(square));
    }
    return !is_far;
  }

  /// With c = n·l, (n·h)² = (1 + c) / 2 = 1 - u, where u = |n - l|² / 4: this form loses no digits near n.
  ///
  /// The mean of the lobe K over a node of directions l + δ is K + K' m + K'' v / 2, where m and v are the mean and the
  /// mean square of -n·δ / 2. For K = c / d², d = u + α² (1 - u), with b = (1 - α²) / d and e = 1 + b c, K' is
  /// -2 e / d² and K'' is 2 b (3 e + 1) / d². The part of δ that is perpendicular to l gives m the first moments, each
  /// channel's its own, and the part along l, -|δ|² / 2, gives it the trace of the second ones.
  [[gnu::always_inline]] void add(const LightTree::Node& node, const NodePlace& place) {
    const Vector<F> l = broadcast(place.of_light), x_axis = broadcast(place.basis.first),
                    y_axis = broadcast(place.basis.second);
    const F one(1.0f), zero(0.0f), quarter(0.25f), angle(node.solid_angle);
    const Moments of_light(node.of_light), of_angle(node.of_angle);
    for (int k = 0; k < vectors; ++k) {
      const Vector<F> away = direction[k] - l;
      const F u = dot(away, away) * quarter, rest = one - u, cosine = one - (u + u);
      const F x = dot(away, x_axis), y = dot(away, y_axis), xx = x * x, xy = x * y, yy = y * y;
      const F square = of_light.square(xx, xy, yy), mean = of_light.mean * cosine;
      const auto shift = [&](const float(&first)[2]) { return x * F(first[0]) + y * F(first[1]); };
      F shift_of_light[Channels];
      for (int c = 0; c < Channels; ++c) shift_of_light[c] = shift(node.first[c]);
      const F square_of_angle = of_angle.square(xx, xy, yy),
              mean_of_angle = of_angle.mean * cosine - shift(node.centre);
      const auto is_above = cosine > zero;
      for (int a = 0; a < lobes; ++a) {
        const F inverse = one / (u + alpha2[a] * rest), b = (one - alpha2[a]) * inverse;
        const F slope = one + b * cosine, scale = select(is_above, inverse * inverse, zero);
        const F second = b * (F(3.0f) * slope + one), scaled_slope = scale * slope;
        const F of_node = scale * (cosine + second * square - slope * mean);
        for (int c = 0; c < Channels; ++c)
          light[a][k][c] = light[a][k][c] + F(node.light[c]) * of_node + shift_of_light[c] * scaled_slope;
        weight[a][k] = weight[a][k] + angle * (scale * (cosine + second * square_of_angle - slope * mean_of_angle));
      }
    }
  }

  void store(RadianceBlock* out) const {
    for (int a = 0; a < lobes; ++a)
      for (int k = 0; k < vectors; ++k)
        for (int c = 0; c < 3; ++c) {
          float* const channel = c == 0 ? out[a].r : c == 1 ? out[a].g : out[a].b;
          (light[a][k][std::min(c, Channels - 1)] / weight[a][k]).store(channel + k * F::lanes);
        }
  }
};

/// A walk of the tree, depth first, in an order that depends on the block alone.
template <class F, int Channels>
void filter_lobes(const LightTree& tree, const Lobes& lobes, const DirectionBlock& directions, RadianceBlock* out) {
  const Division division(lobes, directions);
  LobeSums<F, Channels> sums(directions, lobes);

  struct Place {
    int side, face, x, y;
  };
  const int finest = tree.texel_parts * tree.side;
  Place stack[cube::faces + 3 * 16];
  int depth = 0;
  for (int face = cube::faces - 1; face >= 0; --face) stack[depth++] = {1, face, 0, 0};
  while (depth > 0) {
    const Place p = stack[--depth];
    LightTree::Node part;
    if (p.side > tree.side) part = tree.part(p.side / tree.side, p.face, p.x, p.y);
    const LightTree::Node& node = p.side > tree.side ? part : tree.node(p.side, p.face, p.x, p.y);
    const NodePlace place(node);
    const auto limits = division.limits(node, place, 2 / static_cast<float>(p.side));
    if (limits.is_below) continue;
    const bool is_divided =
        p.side < finest && (limits.is_divided || (!limits.is_whole && sums.is_near(place, limits.distance2)));
    if (!is_divided) {
      sums.add(node, place);
      continue;
    }
    for (int k = 3; k >= 0; --k) stack[depth++] = {2 * p.side, p.face, 2 * p.x + k % 2, 2 * p.y + k / 2};
  }
  sums.store(out);
}

/// See PrefilterKernels.
template <class F>
void filter(const LightTree& tree, const Lobes& lobes, const DirectionBlock& directions, RadianceBlock* out) {
  tree.is_grey ? filter_lobes<F, 1>(tree, lobes, directions, out) : filter_lobes<F, 3>(tree, lobes, directions, out);
}

}  // namespace zoneplate::stages
