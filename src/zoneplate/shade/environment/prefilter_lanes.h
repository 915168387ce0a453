// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

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

/// Which nodes are divided.
struct Division {
  Cone cone;
  float detail, core, width_at_horizon;
  static constexpr float horizon = 1.41421356f;  ///< the chord of a right angle

  /// The wider the lobe, the more light arrives from near the horizon, where the lobe ends abruptly.
  [[gnu::always_inline]] Division(const Lobe& lobe, const DirectionBlock& block)
      : cone(cone_of(block)),
        detail(lobe.detail),
        core(std::min(2 * lobe.alpha, 0.7f)),
        width_at_horizon(0.08f / lobe.alpha) {}

  /// The least number of equal parts along each axis into which a node of this width is divided: 1 where it is taken
  /// whole, 0 where it is skipped.
  [[gnu::always_inline]] int parts(const LightTree::Node& node, float width, float prominence) const {
    const float3 away = float3{node.direction[0], node.direction[1], node.direction[2]} - cone.centre;
    const float distance = std::sqrt(dot(away, away)) - cone.radius;
    // A node is at most √2 widths long.
    const float above = horizon - (distance - 1.5f * width);
    if (above < 0) return 0;
    const bool straddles = above < 3 * width + 2 * cone.radius;
    const float limit = std::min(detail * std::max(distance, core), straddles ? width_at_horizon : 1.0f) / prominence;
    return width > limit ? (width > 2 * limit ? 4 : 2) : 1;
  }
};

/// The weighted sums of the directions of a block.
template <class F>
struct LobeSums {
  static constexpr int vectors = DirectionBlock::size / F::lanes;
  Vector<F> direction[vectors], light[vectors];
  F weight[vectors];

  explicit LobeSums(const DirectionBlock& b) {
    for (int k = 0; k < vectors; ++k) {
      const int i = k * F::lanes;
      direction[k] = {F::load(b.x + i), F::load(b.y + i), F::load(b.z + i)};
      light[k] = {F(0.0f), F(0.0f), F(0.0f)};
      weight[k] = F(0.0f);
    }
  }

  /// With c = n·l, (n·h)² = (1 + c) / 2 = 1 - u, where u = |n - l|² / 4: this form loses no digits near n.
  [[gnu::always_inline]] void add(const LightTree::Node& node, float alpha2) {
    const auto l = Vector<F>::all(node.direction), light_of_node = Vector<F>::all(node.light);
    const F angle(node.solid_angle), one(1.0f);
    for (int k = 0; k < vectors; ++k) {
      const Vector<F> away = direction[k] - l;
      const F u = dot(away, away) * F(0.25f);
      const F d = u + F(alpha2) * (one - u);
      const F lobe = max(one - (u + u), F(0.0f)) / (d * d);
      light[k] = light[k] + light_of_node * lobe;
      weight[k] = weight[k] + angle * lobe;
    }
  }

  void store(RadianceBlock& out) const {
    for (int k = 0; k < vectors; ++k) {
      const int i = k * F::lanes;
      (light[k].x / weight[k]).store(out.r + i);
      (light[k].y / weight[k]).store(out.g + i);
      (light[k].z / weight[k]).store(out.b + i);
    }
  }
};

/// A walk of the tree, depth first, in an order that depends on the block alone.
template <class F>
void filter(const LightTree& tree, const Lobe& lobe, const DirectionBlock& directions, RadianceBlock& out) {
  const Division division(lobe, directions);
  const float alpha2 = lobe.alpha * lobe.alpha;
  LobeSums<F> sums(directions);

  struct Place {
    int side, face, x, y;
  };
  Place stack[cube::faces + 3 * 16];
  int depth = 0;
  for (int face = cube::faces - 1; face >= 0; --face) stack[depth++] = {1, face, 0, 0};
  while (depth > 0) {
    const Place p = stack[--depth];
    const LightTree::Node& node = tree.node(p.side, p.face, p.x, p.y);
    const bool is_leaf = p.side == tree.side;
    const int parts = division.parts(node, 2 / static_cast<float>(p.side), node.prominence);
    if (parts == 1) {
      sums.add(node, alpha2);
    } else if (parts > 1 && !is_leaf) {
      for (int k = 3; k >= 0; --k) stack[depth++] = {2 * p.side, p.face, 2 * p.x + k % 2, 2 * p.y + k / 2};
    } else if (parts > 1) {
      LightTree::Node in_leaf[16];
      tree.divide(p.face, p.x, p.y, parts, in_leaf);
      for (int k = 0; k < parts * parts; ++k) sums.add(in_leaf[k], alpha2);
    }
  }
  sums.store(out);
}

}  // namespace zoneplate::stages
