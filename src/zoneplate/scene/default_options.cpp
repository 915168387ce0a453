// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/default_options.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

double points_of(const Scene& scene) {
  double points = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    if (mesh.topology == Topology::Points) points += static_cast<double>(mesh.primitives());
  }
  return points;
}

float default_point_size(double points, int width, int height) {
  constexpr double part = 1.0 / 16;
  const double area = part * width * height / std::max(points, 1.0), most = height / 100.0;
  return static_cast<float>(std::max(std::min(std::sqrt(area), most), 1.0));
}

float default_point_size(const Scene& scene, int width, int height) {
  return default_point_size(points_of(scene), width, height);
}

}  // namespace zoneplate
