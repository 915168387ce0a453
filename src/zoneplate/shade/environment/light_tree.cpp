// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/light_tree.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

using Node = LightTree::Node;

Node leaf(const CubeImage& cube, int face, int x, int y) {
  const float3 p = cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side));
  const float square = dot(p, p), length = std::sqrt(square);
  const float width = 2 / static_cast<float>(cube.side);
  // The area of the texel over the cube of its distance.
  const float angle = width * width / (square * length);
  const float3 d = p * (1 / length), light = cube.texels[cube.index(face, x, y)] * angle;
  return {{d.x, d.y, d.z}, angle, {light.x, light.y, light.z}, 0};
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

LightTree make_light_tree(const CubeImage& cube) {
  LightTree tree;
  tree.side = cube.side;
  tree.nodes.resize(LightTree::offset(2 * cube.side));
  const auto fill = [&](int side, auto node) {
    Node* const first = tree.nodes.data() + LightTree::offset(side);
    parallel_for(static_cast<std::size_t>(cube::faces * side), [&](std::size_t row) {
      const int face = static_cast<int>(row) / side, y = static_cast<int>(row) % side;
      for (int x = 0; x < side; ++x)
        first[row * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)] = node(face, x, y);
    });
  };
  fill(cube.side, [&](int face, int x, int y) { return leaf(cube, face, x, y); });
  for (int side = cube.side / 2; side > 0; side /= 2)
    fill(side, [&](int face, int x, int y) {
      const auto part = [&](int dx, int dy) { return &tree.node(2 * side, face, 2 * x + dx, 2 * y + dy); };
      const Node* const parts[4] = {part(0, 0), part(1, 0), part(0, 1), part(1, 1)};
      return sum(parts);
    });
  return tree;
}

}  // namespace zoneplate
