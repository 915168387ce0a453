// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/light_tree.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

using Node = LightTree::Node;

float3 direction_of(const Node& n) { return {n.direction[0], n.direction[1], n.direction[2]}; }

float3 centre_of(const Node& n) { return {n.centre[0], n.centre[1], n.centre[2]}; }

void set(float (&to)[3], float3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/// The even light from the square of a face about a point, with sides of this width.
Node square(int face, float s, float t, float width, float3 radiance) {
  const float3 p = cube::point(face, s, t);
  const float distance2 = dot(p, p), distance = std::sqrt(distance2);
  Node out{};
  // The area over the cube of the distance.
  out.solid_angle = width * width / (distance2 * distance);
  out.spread = out.even_spread = out.solid_angle / 12;
  out.prominence = out.fineness = 1;
  set(out.direction, p * (1 / distance));
  set(out.light, radiance * out.solid_angle);
  return out;
}

/// The weights of three control points in the mean of the quadratic B-spline over a part of a texel, and in its first
/// moment about the part's centre, in texels.
struct PartWeights {
  float mean[3], moment[3];
};
constexpr PartWeights weights_of(int part, int parts) {
  const float u = (2 * static_cast<float>(part) + 1) / static_cast<float>(2 * parts) - 0.5f;
  const float before = 0.5f - u, after = 0.5f + u, variance = 1 / static_cast<float>(12 * parts * parts);
  return {{(before * before + variance) * 0.5f, 0.75f - u * u - variance, (after * after + variance) * 0.5f},
          {-before * variance, -2 * u * variance, after * variance}};
}

/// Of all parts: part k of 1, 2, 4 ... equal ones is element parts - 1 + k.
struct AllPartWeights {
  PartWeights of[2 * LightTree::most_parts - 1];
  constexpr AllPartWeights() : of{} {
    for (int parts = 1; parts <= LightTree::most_parts; parts *= 2)
      for (int k = 0; k < parts; ++k) of[parts - 1 + k] = weights_of(k, parts);
  }
};
constexpr AllPartWeights part_weights;

/// The mean of the radiance over a part of a texel, and its first moments about the part's centre, in texels.
struct PartMoments {
  float3 mean, along_s, along_t;
};
PartMoments moments_of(const BorderedCube& points, int face, int x, int y, const PartWeights& across,
                       const PartWeights& down) {
  PartMoments out{};
  for (int k = 0; k < 3; ++k) {
    const float3 before = points.at(face, x - 1, y + k - 1), at = points.at(face, x, y + k - 1),
                 after = points.at(face, x + 1, y + k - 1);
    const float3 mean = before * across.mean[0] + at * across.mean[1] + after * across.mean[2];
    const float3 moment = before * across.moment[0] + at * across.moment[1] + after * across.moment[2];
    out.mean = out.mean + mean * down.mean[k];
    out.along_s = out.along_s + moment * down.mean[k];
    out.along_t = out.along_t + mean * down.moment[k];
  }
  return out;
}

/// The part of a vector that is perpendicular to a unit vector.
float3 tangential(float3 v, float3 direction) { return v - direction * dot(v, direction); }

float sum_of(float3 c) { return c.x + c.y + c.z; }
float power(const Node& n) { return n.light[0] + n.light[1] + n.light[2]; }

/// The light of a part of a texel, of which there are `parts` along each edge; (x, y) counts parts.
Node node_of(const BorderedCube& texels, int parts, int face, int x, int y) {
  const PartWeights* const weights = part_weights.of + parts - 1;
  const PartMoments moments = moments_of(texels, face, x / parts, y / parts, weights[x % parts], weights[y % parts]);
  const int side = texels.side * parts;
  const float s = cube::centre(x, side), t = cube::centre(y, side), total = sum_of(moments.mean);
  Node out = square(face, s, t, 2 / static_cast<float>(side), moments.mean);
  if (!(total > 0)) return out;
  const float width_over_total = 2 / (static_cast<float>(texels.side) * total);
  const float3 of_light =
      cube::point(face, s + sum_of(moments.along_s) * width_over_total, t + sum_of(moments.along_t) * width_over_total);
  const float inverse = 1 / std::sqrt(dot(of_light, of_light));
  const float3 direction = of_light * inverse;
  set(out.direction, direction);
  set(out.centre, tangential((cube::point(face, s, t) - of_light) * inverse, direction));
  return out;
}

Node sum(const Node* const (&parts)[4]) {
  Node all{};
  float total = 0;
  for (const Node* part : parts) total += power(*part);
  const auto weight = [&](const Node& part) { return total > 0 ? power(part) : part.solid_angle; };
  float3 mean{0, 0, 0}, even_mean{0, 0, 0};
  float weights = 0;
  for (const Node* part : parts) {
    all.solid_angle += part->solid_angle;
    for (int c = 0; c < 3; ++c) all.light[c] += part->light[c];
    mean = mean + direction_of(*part) * weight(*part);
    weights += weight(*part);
    even_mean = even_mean + (direction_of(*part) + centre_of(*part)) * part->solid_angle;
  }
  even_mean = even_mean * (1 / all.solid_angle);
  const float3 direction = normalize(mean);
  for (const Node* part : parts) {
    const float3 away = direction_of(*part) - direction, even_away = direction_of(*part) + centre_of(*part) - even_mean;
    all.spread += (part->spread + dot(away, away) * 0.5f) * (weight(*part) / weights);
    all.even_spread += (part->even_spread + dot(even_away, even_away) * 0.5f) * (part->solid_angle / all.solid_angle);
  }
  set(all.direction, direction);
  set(all.centre, tangential(even_mean - direction, direction));
  return all;
}

}  // namespace

float3 LightTree::mean() const {
  float3 light{0, 0, 0};
  float angle = 0;
  for (int face = 0; face < cube::faces; ++face) {
    const Node& n = node(1, face, 0, 0);
    light = light + float3{n.light[0], n.light[1], n.light[2]};
    angle += n.solid_angle;
  }
  return light * (1 / angle);
}

void LightTree::weigh(Node& n) const {
  // The lobe's expansion over a node has terms of the second order, so that nodes whose light is on one side need the
  // most detail.
  constexpr float one_sided = 8;
  n.prominence = std::sqrt(std::max(power(n) / (n.solid_angle * mean_power), 1.0f));
  const float eighth_root = std::sqrt(std::sqrt(n.prominence));
  n.fineness = eighth_root +
               one_sided * (eighth_root * eighth_root) * std::sqrt(dot(centre_of(n), centre_of(n)) / n.solid_angle);
}

LightTree::Node LightTree::part(int parts, int face, int x, int y) const {
  Node out = node_of(texels, parts, face, x, y);
  const Node& texel = node(side, face, x / parts, y / parts);
  out.prominence = texel.prominence, out.fineness = texel.fineness;
  return out;
}

LightTree make_light_tree(const CubeImage& cube) {
  LightTree tree;
  tree.side = cube.side;
  tree.texels = with_border(cube);
  tree.nodes.resize(LightTree::offset(2 * cube.side));
  const auto fill = [&](int side, auto node) {
    Node* const first = tree.nodes.data() + LightTree::offset(side);
    parallel_for(static_cast<std::size_t>(cube::faces * side), [&](std::size_t row) {
      const int face = static_cast<int>(row) / side, y = static_cast<int>(row) % side;
      for (int x = 0; x < side; ++x)
        first[row * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)] = node(face, x, y);
    });
  };
  fill(cube.side, [&](int face, int x, int y) { return node_of(tree.texels, 1, face, x, y); });
  for (int side = cube.side / 2; side > 0; side /= 2)
    fill(side, [&](int face, int x, int y) {
      const auto part = [&](int dx, int dy) { return &tree.node(2 * side, face, 2 * x + dx, 2 * y + dy); };
      const Node* const parts[4] = {part(0, 0), part(1, 0), part(0, 1), part(1, 1)};
      return sum(parts);
    });
  const float3 mean = tree.mean();
  tree.mean_power = std::max(mean.x + mean.y + mean.z, 1e-30f);
  for (Node& n : tree.nodes) tree.weigh(n);
  return tree;
}

}  // namespace zoneplate
