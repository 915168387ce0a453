// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/light_tree.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

using Node = LightTree::Node;

/// The light from the square of a face about a point, with sides of this width.
Node square(int face, float s, float t, float width, float3 radiance) {
  const float3 p = cube::point(face, s, t);
  const float distance2 = dot(p, p), distance = std::sqrt(distance2);
  // The area over the cube of the distance.
  const float angle = width * width / (distance2 * distance);
  const float3 d = p * (1 / distance), light = radiance * angle;
  return {{d.x, d.y, d.z}, angle, {light.x, light.y, light.z}, 1};
}

/// The mean of the quadratic B-spline over a texel.
float3 mean_in_texel(const BorderedCube& points, int face, int x, int y) {
  const auto in_row = [&](int row) {
    return points.at(face, x, row) * (2.0f / 3) +
           (points.at(face, x - 1, row) + points.at(face, x + 1, row)) * (1.0f / 6);
  };
  return in_row(y) * (2.0f / 3) + (in_row(y - 1) + in_row(y + 1)) * (1.0f / 6);
}

float power(const Node& n) { return n.light[0] + n.light[1] + n.light[2]; }

Node sum(const Node* const (&parts)[4]) {
  Node all{};
  float total = 0;
  for (const Node* part : parts) total += power(*part);
  float3 direction{0, 0, 0};
  for (const Node* part : parts) {
    all.solid_angle += part->solid_angle;
    for (int c = 0; c < 3; ++c) all.light[c] += part->light[c];
    const float weight = total > 0 ? power(*part) : part->solid_angle;
    direction = direction + float3{part->direction[0], part->direction[1], part->direction[2]} * weight;
  }
  direction = normalize(direction);
  all.direction[0] = direction.x, all.direction[1] = direction.y, all.direction[2] = direction.z;
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
  fill(cube.side, [&](int face, int x, int y) {
    return square(face, cube::centre(x, cube.side), cube::centre(y, cube.side), 2 / static_cast<float>(cube.side),
                  mean_in_texel(tree.texels, face, x, y));
  });
  for (int side = cube.side / 2; side > 0; side /= 2)
    fill(side, [&](int face, int x, int y) {
      const auto part = [&](int dx, int dy) { return &tree.node(2 * side, face, 2 * x + dx, 2 * y + dy); };
      const Node* const parts[4] = {part(0, 0), part(1, 0), part(0, 1), part(1, 1)};
      return sum(parts);
    });
  const float3 mean = tree.mean();
  const float threshold = std::max(mean.x + mean.y + mean.z, 1e-30f);
  for (Node& n : tree.nodes) n.prominence = std::sqrt(std::max(power(n) / (n.solid_angle * threshold), 1.0f));
  return tree;
}

}  // namespace zoneplate
