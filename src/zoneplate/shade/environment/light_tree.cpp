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
  out.prominence = 1;
  set(out.direction, p * (1 / distance));
  set(out.light, radiance * out.solid_angle);
  return out;
}

/// The quadratic B-spline over a texel: its mean, and the first moments about the centre, in texels.
struct TexelMoments {
  float3 mean, along_s, along_t;
};
TexelMoments moments_of(const BorderedCube& points, int face, int x, int y) {
  constexpr float inner = 2.0f / 3, outer = 1.0f / 6, slope = 1.0f / 24;
  float3 mean[3], along_s[3];
  for (int k = 0; k < 3; ++k) {
    const float3 before = points.at(face, x - 1, y + k - 1), after = points.at(face, x + 1, y + k - 1);
    mean[k] = points.at(face, x, y + k - 1) * inner + (after + before) * outer;
    along_s[k] = (after - before) * slope;
  }
  return {mean[1] * inner + (mean[0] + mean[2]) * outer, along_s[1] * inner + (along_s[0] + along_s[2]) * outer,
          (mean[2] - mean[0]) * slope};
}

float sum_of(float3 c) { return c.x + c.y + c.z; }
float power(const Node& n) { return n.light[0] + n.light[1] + n.light[2]; }

/// The light from a texel.
Node leaf(const BorderedCube& points, int face, int x, int y) {
  const TexelMoments moments = moments_of(points, face, x, y);
  const float s = cube::centre(x, points.side), t = cube::centre(y, points.side);
  const float width = 2 / static_cast<float>(points.side), total = sum_of(moments.mean);
  Node out = square(face, s, t, width, moments.mean);
  if (!(total > 0)) return out;
  const float3 centre = direction_of(out);
  const float3 of_light = normalize(
      cube::point(face, s + width * (sum_of(moments.along_s) / total), t + width * (sum_of(moments.along_t) / total)));
  set(out.direction, of_light);
  const float3 away = centre - of_light;
  set(out.centre, away);
  out.even_spread += dot(away, away) * 0.5f;
  return out;
}

Node sum(const Node* const (&parts)[4]) {
  Node all{};
  float total = 0;
  for (const Node* part : parts) total += power(*part);
  const auto weight = [&](const Node& part) { return total > 0 ? power(part) : part.solid_angle; };
  float3 direction{0, 0, 0}, centre{0, 0, 0};
  float weights = 0;
  for (const Node* part : parts) {
    all.solid_angle += part->solid_angle;
    for (int c = 0; c < 3; ++c) all.light[c] += part->light[c];
    direction = direction + direction_of(*part) * weight(*part);
    weights += weight(*part);
    centre = centre + (direction_of(*part) + centre_of(*part)) * part->solid_angle;
  }
  direction = normalize(direction);
  for (const Node* part : parts) {
    const float3 away = direction_of(*part) - direction;
    const float half_square = dot(away, away) * 0.5f;
    all.spread += (part->spread + half_square) * (weight(*part) / weights);
    all.even_spread +=
        (part->even_spread + dot(centre_of(*part), away) + half_square) * (part->solid_angle / all.solid_angle);
  }
  set(all.direction, direction);
  set(all.centre, normalize(centre) - direction);
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

void LightTree::divide(int face, int x, int y, int parts, Node* out) const {
  const auto between = [parts](int part, float3 before, float3 at, float3 after) {
    const float u = cube::centre(part, parts) * 0.5f;
    return before * ((0.5f - u) * (0.5f - u) * 0.5f) + at * (0.75f - u * u) + after * ((0.5f + u) * (0.5f + u) * 0.5f);
  };
  for (int i = 0; i < parts; ++i) {
    const auto in_row = [&](int row) {
      return between(i, texels.at(face, x - 1, row), texels.at(face, x, row), texels.at(face, x + 1, row));
    };
    const float3 above = in_row(y - 1), at = in_row(y), below = in_row(y + 1);
    for (int j = 0; j < parts; ++j)
      out[j * parts + i] =
          square(face, cube::centre(x * parts + i, side * parts), cube::centre(y * parts + j, side * parts),
                 2 / static_cast<float>(side * parts), between(j, above, at, below));
  }
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
  fill(cube.side, [&](int face, int x, int y) { return leaf(tree.texels, face, x, y); });
  for (int side = cube.side / 2; side > 0; side /= 2)
    fill(side, [&](int face, int x, int y) {
      const auto part = [&](int dx, int dy) { return &tree.node(2 * side, face, 2 * x + dx, 2 * y + dy); };
      const Node* const parts[4] = {part(0, 0), part(1, 0), part(0, 1), part(1, 1)};
      return sum(parts);
    });
  const float3 mean = tree.mean();
  const float threshold = std::max(mean.x + mean.y + mean.z, 1e-30f);
  for (Node& n : tree.nodes)
    n.prominence = std::sqrt(std::sqrt(std::max(power(n) / (n.solid_angle * threshold), 1.0f)));
  return tree;
}

}  // namespace zoneplate
