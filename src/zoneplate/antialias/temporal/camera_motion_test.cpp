// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "zoneplate/math/transform.h"

namespace zoneplate::antialias {
namespace {

Camera camera_turned_by(float3 axis, float angle) {
  Camera camera;
  camera.world_from_camera = translation(float3{1, 2, 3}) * rotation(axis, angle);
  return camera;
}

TEST(CameraMotion, BackgroundsOfARowMoveAsTheirPixels) {
  constexpr int width = 64, height = 48;
  Camera wider = camera_turned_by({0, 1, 0}, 0.01f);
  wider.vertical_fov *= 1.25f;
  Camera flat = camera_turned_by({0, 1, 0}, 0.01f);
  flat.is_orthographic = true;
  Camera moved = camera_turned_by({0.6f, 0.8f, 0}, 0.31f);
  moved.world_from_camera = translation(float3{0.1f, 0.2f, -0.3f}) * moved.world_from_camera;
  const Camera now = camera_turned_by({0.6f, 0.8f, 0}, 0.3f);
  for (const Camera& last : {now, camera_turned_by({0.6f, 0.8f, 0}, 0.31f), camera_turned_by({0, 0, 1}, 1),
                             camera_turned_by({0, 1, 0}, 2), wider, flat, moved}) {
    const CameraMotion motion(now, last, 1.0f * width / height, width, height);
    std::vector<float> x(width), y(width), distance(width);
    for (const double row : {0.5, 17.25, 47.75}) {
      motion.of_background(0.375, row, width, x.data(), y.data());
      for (int i = 0; i < width; ++i) {
        const float2 alone = motion.at(0.375 + i, row, std::numeric_limits<double>::infinity());
        const auto k = static_cast<std::size_t>(i);
        EXPECT_NEAR(x[k], alone.x, 1e-6f * (1 + std::abs(alone.x)));
        EXPECT_NEAR(y[k], alone.y, 1e-6f * (1 + std::abs(alone.y)));
      }
      for (std::size_t k = 0; k < distance.size(); ++k)
        distance[k] = k % 5 == 0 ? std::numeric_limits<float>::infinity() : 0.3f + 0.7f * static_cast<float>(k % 11);
      motion.along_row(0.375, row, distance, x.data(), y.data());
      for (std::size_t k = 0; k < distance.size(); ++k) {
        const float2 alone = motion.at(0.375 + static_cast<double>(k), row, static_cast<double>(distance[k]));
        EXPECT_NEAR(x[k], alone.x, 1e-6f * (1 + std::abs(alone.x)));
        EXPECT_NEAR(y[k], alone.y, 1e-6f * (1 + std::abs(alone.y)));
      }
    }
  }
}

}  // namespace
}  // namespace zoneplate::antialias
