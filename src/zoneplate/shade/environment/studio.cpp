// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/studio.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/shade/environment/prepared_environment.h"

namespace zoneplate {
namespace {

/// A rectangle of light. Its sides are the tangents of the half angles that it covers; its edges are soft.
struct Box {
  float3 towards;
  float width, height;
  float radiance;
  float softness;  ///< of the edge, relative to half a side
};

constexpr Box boxes[] = {
    {{-0.58f, 0.62f, 0.53f}, 0.42f, 0.36f, 3.2f, 0.12f},   // key
    {{0.10f, 1.00f, -0.20f}, 0.80f, 0.26f, 1.4f, 0.20f},   // overhead
    {{1.00f, 0.12f, 0.42f}, 0.36f, 0.80f, 1.0f, 0.25f},    // card
    {{-0.64f, 0.22f, -0.94f}, 0.13f, 0.90f, 3.0f, 0.20f},  // strips
    {{0.62f, 0.30f, -0.96f}, 0.13f, 0.90f, 3.0f, 0.20f},
};

float smooth(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// Light falls off towards the edges, as behind the cloth of a soft box.
float light_of(const Box& box, float3 d) {
  const float3 axis = normalize(box.towards);
  const float ahead = dot(d, axis);
  if (ahead <= 0.05f) return 0;
  const float3 right = normalize(cross({0, 1, 0}, axis)), up = cross(axis, right);
  const float x = std::abs(dot(d, right)) / (ahead * box.width), y = std::abs(dot(d, up)) / (ahead * box.height);
  const auto edge = [&](float t) { return 1 - smooth(1 - box.softness, 1 + box.softness, t); };
  return box.radiance * edge(x) * edge(y) * (1 - 0.2f * std::min(x * x + y * y, 2.0f));
}

float radiance(float3 d) {
  // Walls that darken a little towards the floor's horizon, with a reflector behind the viewer, and the glow of the
  // floor before the viewer.
  const float walls = 0.12f + 0.06f * smooth(-0.1f, 1, d.y) + 0.40f * smooth(0.25f, 1, d.z);
  const float floor = 0.20f * smooth(0.02f, -0.75f, d.y) * (0.8f + 0.2f * d.z);
  float sum = walls + floor;
  for (const Box& box : boxes) sum += light_of(box, d);
  return sum;
}

}  // namespace

float3 studio_key() { return normalize(boxes[0].towards); }

std::uint64_t studio_key_number() {
  // A few texels vary with every part of the studio.
  const CubeImage probe = studio_cube(16);
  return content_hash(
      {reinterpret_cast<const std::uint8_t*>(probe.texels.data()), probe.texels.size() * sizeof(float3)});
}

CubeImage studio_cube(int side) {
  CubeImage cube{side, std::vector<float3>(static_cast<std::size_t>(cube::faces * side * side))};
  parallel_for(static_cast<std::size_t>(cube::faces * side), [&](std::size_t row) {
    const int face = static_cast<int>(row) / side, y = static_cast<int>(row) % side;
    for (int x = 0; x < side; ++x) {
      const float light = radiance(normalize(cube::point(face, cube::centre(x, side), cube::centre(y, side))));
      cube.texels[cube.index(face, x, y)] = {light, light, light};
    }
  });
  return cube;
}

std::shared_ptr<const PreparedEnvironment> shared_studio() {
  static const auto made = std::make_shared<const PreparedEnvironment>(prepare_studio());
  return made;
}

}  // namespace zoneplate
