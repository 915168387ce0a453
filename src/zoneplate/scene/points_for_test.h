// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A mesh of `count` points with two instances: one with the identity and one translated by `offset`. Point i is at
/// position(a, b, c) for three random numbers in [0, 1); mesh.index is empty.
template <class Position>
Scene point_scene(std::uint32_t count, float3 offset, Position position) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.topology = Topology::Points;
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.position.push_back(position(unit_float(hash(i, 1)), unit_float(hash(i, 2)), unit_float(hash(i, 3))));
  scene.materials.emplace_back();
  scene.instances.resize(2);
  scene.instances[1].world_from_object = translation(offset);
  return scene;
}

}  // namespace zoneplate
