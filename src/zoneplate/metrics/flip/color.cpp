// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/flip/color.h"

#include <cmath>

#include "zoneplate/metrics/power.h"

namespace zoneplate::metrics {
namespace {

constexpr Triple white = {0.950428545, 1, 1.088900371};

/// CIELAB's compression: a cube root, linear near black.
double compress(double t) {
  constexpr double delta = 6.0 / 29;
  return t > delta * delta * delta ? cube_root(t) : t / (3 * delta * delta) + 4.0 / 29;
}

}  // namespace

Triple xyz_from_rgb(Triple c) {
  return {(10135552.0 * c.x + 8788810.0 * c.y + 4435075.0 * c.z) / 24577794.0,
          (2613072.0 * c.x + 8788810.0 * c.y + 887015.0 * c.z) / 12288897.0,
          (1425312.0 * c.x + 8788810.0 * c.y + 70074185.0 * c.z) / 73733382.0};
}

Triple rgb_from_xyz(Triple c) {
  return {3.241003275 * c.x - 1.537398934 * c.y - 0.498615861 * c.z,
          -0.969224334 * c.x + 1.875930071 * c.y + 0.041554224 * c.z,
          0.055639423 * c.x - 0.204011202 * c.y + 1.057148933 * c.z};
}

Triple opponent_from_rgb(Triple rgb) {
  const Triple xyz = xyz_from_rgb(rgb);
  const double x = xyz.x / white.x, y = xyz.y / white.y, z = xyz.z / white.z;
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Triple rgb_from_opponent(Triple c) {
  const double y = (c.x + 16) / 116;
  return rgb_from_xyz({(y + c.y / 500) * white.x, y * white.y, (y - c.z / 200) * white.z});
}

Triple hunt_lab_from_rgb(Triple rgb) {
  const Triple xyz = xyz_from_rgb(rgb);
  const double x = compress(xyz.x / white.x), y = compress(xyz.y / white.y), z = compress(xyz.z / white.z);
  const double lightness = 116 * y - 16;
  return {lightness, 500 * (x - y) * (0.01 * lightness), 200 * (y - z) * (0.01 * lightness)};
}

double hyab(Triple a, Triple b) {
  const double da = a.y - b.y, db = a.z - b.z;
  return std::abs(a.x - b.x) + std::sqrt(da * da + db * db);
}

}  // namespace zoneplate::metrics
