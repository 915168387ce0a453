// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/light_tree.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/basis.h"

namespace zoneplate {
namespace {

using Node = LightTree::Node;
using Squares = LightTree::Squares;

float3 direction_of(const Node& n) { return {n.direction[0], n.direction[1], n.direction[2]}; }

/// The coordinates of a vector near the plane of a basis.
struct Coordinates {
  float x, y;
};
Coordinates along(const Basis& basis, float3 v) { return {dot(basis.first, v), dot(basis.second, v)}; }

void add_product(Squares& to, Coordinates a, Coordinates b, float weight) {
  to.xx += a.x * b.x * weight, to.xy += (a.x * b.y + a.y * b.x) * 0.5f * weight, to.yy += a.y * b.y * weight;
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
  PartWeights of[2 * LightTree::max_parts - 1];
  constexpr AllPartWeights() : of{} {
    for (int parts = 1; parts <= LightTree::max_parts; parts *= 2)
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

float sum_of(float3 c) { return c.x + c.y + c.z; }
float power(const Node& n) { return n.light[0] + n.light[1] + n.light[2]; }

/// Second moments in texels.
struct Variance {
  float ss, st, tt;
};

/// A node of a part of a texel, of which there are `parts` along each edge; (x, y) counts parts. `of_light` is about
/// the centroid of the light of all channels.
Node make_node(const PartMoments& moments, Variance of_light, int texels, int parts, int face, int x, int y) {
  const int side = texels * parts;
  const float s = cube::centre(x, side), t = cube::centre(y, side), width = 2 / static_cast<float>(side);
  const float3 middle = cube::point(face, s, t);
  const float texel = 2 / static_cast<float>(texels), total = sum_of(moments.mean);
  const auto at = [&](float along_s, float along_t) {
    return cube::point(face, s + along_s * texel, t + along_t * texel);
  };
  const float3 centroid = total > 0 ? at(sum_of(moments.along_s) / total, sum_of(moments.along_t) / total) : middle;
  const float inverse = 1 / std::sqrt(dot(centroid, centroid)), inverse_of_middle = 1 / std::sqrt(dot(middle, middle));

  Node out{};
  const float3 direction = centroid * inverse;
  out.direction[0] = direction.x, out.direction[1] = direction.y, out.direction[2] = direction.z;
  const Basis basis(direction);
  // The area over the cube of the distance.
  out.solid_angle = width * width * (inverse_of_middle * inverse_of_middle * inverse_of_middle);
  const Coordinates s_axis = along(basis, (at(1, 0) - at(0, 0)) * inverse),
                    t_axis = along(basis, (at(0, 1) - at(0, 0)) * inverse);
  const Coordinates to_middle = along(basis, (middle - centroid) * inverse);
  const auto set = [&](int channel, float mean, float along_s, float along_t) {
    out.light[channel] = mean * out.solid_angle;
    out.first[channel][0] = (to_middle.x * mean + s_axis.x * along_s + t_axis.x * along_t) * out.solid_angle;
    out.first[channel][1] = (to_middle.y * mean + s_axis.y * along_s + t_axis.y * along_t) * out.solid_angle;
  };
  set(0, moments.mean.x, moments.along_s.x, moments.along_t.x);
  set(1, moments.mean.y, moments.along_s.y, moments.along_t.y);
  set(2, moments.mean.z, moments.along_s.z, moments.along_t.z);
  out.centre[0] = to_middle.x, out.centre[1] = to_middle.y;
  const auto add = [&](Squares& to, Variance v) {
    add_product(to, s_axis, s_axis, v.ss), add_product(to, t_axis, t_axis, v.tt);
    add_product(to, s_axis, t_axis, 2 * v.st);
  };
  const float variance = 1 / static_cast<float>(12 * parts * parts);
  add(out.of_light, of_light);
  add(out.of_angle, {variance, 0, variance});
  add_product(out.of_angle, to_middle, to_middle, 1);
  out.prominence = out.fineness = 1;
  return out;
}

/// The light of the spline in a part of a texel.
Node node_of(const BorderedCube& texels, int parts, int face, int x, int y) {
  const PartWeights* const weights = part_weights.of + parts - 1;
  const PartMoments moments = moments_of(texels, face, x / parts, y / parts, weights[x % parts], weights[y % parts]);
  const float variance = 1 / static_cast<float>(12 * parts * parts);
  return make_node(moments, {variance, 0, variance}, texels.side, parts, face, x, y);
}

/// The light of a texel. Places are counted from the centroid of its directions, and variances are relative to theirs,
/// so that even light has the moments of the texel.
Node node_of(const TexelLight& light, int side, int face, int x, int y) {
  const TexelLight::Sums &power = light.power, &weights = light.weights;
  const float inverse = 1 / weights.one, middle_x = weights.x * inverse, middle_y = weights.y * inverse;
  const float3 mean = light.light * inverse;
  const PartMoments moments{mean, light.light_x * inverse - mean * middle_x, light.light_y * inverse - mean * middle_y};
  const auto variance = [](const TexelLight::Sums& of) {
    const float mean_x = of.x / of.one, mean_y = of.y / of.one;
    return Variance{of.xx / of.one - mean_x * mean_x, of.xy / of.one - mean_x * mean_y,
                    of.yy / of.one - mean_y * mean_y};
  };
  Variance v{1.0f / 12, 0, 1.0f / 12};
  if (power.one > 0) {
    const Variance own = variance(power), even = variance(weights);
    v = {v.ss + (own.ss - even.ss), own.st - even.st, v.tt + (own.tt - even.tt)};
  }
  return make_node(moments, v, side, 1, face, x, y);
}

Node sum(const Node* const (&parts)[4]) {
  Node all{};
  float total = 0;
  for (const Node* part : parts) {
    total += power(*part);
    for (int c = 0; c < 3; ++c) all.light[c] += part->light[c];
    all.solid_angle += part->solid_angle;
  }
  const auto part_of_angle = [&](const Node& part) { return part.solid_angle / all.solid_angle; };
  const auto weight = [&](const Node& part) { return total > 0 ? power(part) / total : part_of_angle(part); };
  float3 mean{0, 0, 0};
  for (const Node* part : parts) mean = mean + direction_of(*part) * weight(*part);
  const float3 direction = normalize(mean);
  all.direction[0] = direction.x, all.direction[1] = direction.y, all.direction[2] = direction.z;
  const Basis basis(direction);
  for (const Node* part : parts) {
    const Basis own(direction_of(*part));
    const Coordinates away = along(basis, direction_of(*part) - direction), x = along(basis, own.first),
                      y = along(basis, own.second);
    for (int c = 0; c < 3; ++c) {
      const float* const first = part->first[c];
      all.first[c][0] += away.x * part->light[c] + x.x * first[0] + y.x * first[1];
      all.first[c][1] += away.y * part->light[c] + x.y * first[0] + y.y * first[1];
    }
    const float weight_of_angle = part_of_angle(*part);
    const Coordinates centre{x.x * part->centre[0] + y.x * part->centre[1],
                             x.y * part->centre[0] + y.y * part->centre[1]};
    all.centre[0] += (away.x + centre.x) * weight_of_angle, all.centre[1] += (away.y + centre.y) * weight_of_angle;
    const auto add = [&](Squares& to, const Squares& squares, float part_of_all) {
      add_product(to, x, x, squares.xx * part_of_all);
      add_product(to, x, y, 2 * squares.xy * part_of_all);
      add_product(to, y, y, squares.yy * part_of_all);
      add_product(to, away, away, part_of_all);
    };
    add(all.of_light, part->of_light, weight(*part));
    add(all.of_angle, part->of_angle, weight_of_angle);
    add_product(all.of_angle, away, centre, 2 * weight_of_angle);
  }
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
  constexpr float one_sided = 4;
  n.prominence = std::sqrt(std::max(power(n) / (n.solid_angle * mean_power), 1.0f));
  const float eighth_root = std::sqrt(std::sqrt(n.prominence)), x = n.centre[0], y = n.centre[1];
  const float shift = std::sqrt((x * x + y * y) / n.solid_angle);
  n.fineness = eighth_root + one_sided * (eighth_root * eighth_root) * shift;
}

LightTree::Node LightTree::part(int parts, int face, int x, int y) const {
  Node out = node_of(texels, parts, face, x, y);
  const Node& texel = node(side, face, x / parts, y / parts);
  out.prominence = texel.prominence, out.fineness = texel.fineness;
  return out;
}

namespace {

bool is_grey_texel(float3 texel) { return texel.x == texel.y && texel.y == texel.z; }

bool is_grey_node(const Node& n) {
  return n.light[0] == n.light[1] && n.light[1] == n.light[2] && std::ranges::equal(n.first[0], n.first[1]) &&
         std::ranges::equal(n.first[1], n.first[2]);
}

/// Of `texel`(face, x, y), the nodes of the finest level.
template <class Texel>
void fill(LightTree& tree, const Texel& texel) {
  tree.nodes.resize(LightTree::offset(2 * tree.side));
  const auto fill_level = [&](int side, auto node) {
    Node* const first = tree.nodes.data() + LightTree::offset(side);
    parallel_for(static_cast<std::size_t>(cube::faces * side), [&](std::size_t row) {
      const int face = static_cast<int>(row) / side, y = static_cast<int>(row) % side;
      for (int x = 0; x < side; ++x)
        first[row * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)] = node(face, x, y);
    });
  };
  fill_level(tree.side, texel);
  for (int side = tree.side / 2; side > 0; side /= 2)
    fill_level(side, [&](int face, int x, int y) {
      const auto part = [&](int dx, int dy) { return &tree.node(2 * side, face, 2 * x + dx, 2 * y + dy); };
      const Node* const parts[4] = {part(0, 0), part(1, 0), part(0, 1), part(1, 1)};
      return sum(parts);
    });
  const float3 mean = tree.mean();
  tree.mean_power = std::max(mean.x + mean.y + mean.z, 1e-30f);
  for (Node& n : tree.nodes) tree.weigh(n);
  tree.is_grey = std::all_of(tree.nodes.begin(), tree.nodes.end(), is_grey_node) &&
                 std::all_of(tree.texels.texels.begin(), tree.texels.texels.end(), is_grey_texel);
}

}  // namespace

LightTree make_light_tree(const CubeImage& cube) {
  LightTree tree;
  tree.side = cube.side;
  tree.texels = with_border(cube);
  fill(tree, [&](int face, int x, int y) { return node_of(tree.texels, 1, face, x, y); });
  return tree;
}

LightTree make_light_tree_of_source(const CubeImage& cube) {
  LightTree tree;
  tree.side = cube.side, tree.texel_parts = 1;
  fill(tree,
       [&](int face, int x, int y) { return node_of(cube.source[cube.index(face, x, y)], cube.side, face, x, y); });
  return tree;
}

}  // namespace zoneplate
