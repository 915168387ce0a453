// SPDX-License-Identifier: Apache-2.0
// The sun behind a roof: an edge between very bright and dark, whose scene-linear mean is displayed as white even if
// only a small part of the pixel is bright.
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace sun_roof_scene {
namespace {

/// The silhouette of the house against the sky: gable, chimney, a lower roof, an aerial.
Mesh make_house() {
  Mesh mesh;
  const float z = 1;
  add_quad(mesh, {{-1.15f, -0.18f, z}, {0.62f, -0.18f, z}, {0.02f, 0.53f, z}, {-0.55f, 0.53f, z}});  // the great roof
  add_quad(mesh, {{-1.02f, -2, z}, {0.50f, -2, z}, {0.50f, -0.18f, z}, {-1.02f, -0.18f, z}});
  add_quad(mesh, {{-0.46f, 0.40f, z}, {-0.30f, 0.40f, z}, {-0.30f, 0.76f, z}, {-0.46f, 0.76f, z}});  // chimney
  add_quad(mesh, {{-0.485f, 0.76f, z}, {-0.275f, 0.76f, z}, {-0.275f, 0.80f, z}, {-0.485f, 0.80f, z}});
  add_quad(mesh, {{0.50f, -0.62f, z}, {2.6f, -0.34f, z}, {2.6f, -0.28f, z}, {0.50f, -0.53f, z}});  // the shed
  add_quad(mesh, {{0.50f, -2, z}, {2.6f, -2, z}, {2.6f, -0.34f, z}, {0.50f, -0.62f, z}});
  add_bar(mesh, {0.24f, 0.20f, z}, {0.28f, 0.93f, z}, 0.004f);  // aerial
  for (int i = 0; i < 5; ++i) {
    const float y = 0.66f + 0.05f * static_cast<float>(i), half = 0.11f - 0.012f * static_cast<float>(i);
    add_bar(mesh, {0.268f - half, y - 0.02f, z}, {0.268f + half, y + 0.02f, z}, 0.0028f);
  }
  return mesh;
}

/// The lower edges of the tiles, slightly brighter than the roof.
Mesh make_tiles() {
  Mesh mesh;
  for (int row = 1; row < 12; ++row) {
    const float t = static_cast<float>(row) / 12, y = -0.18f + 0.71f * t;
    const float left = -1.15f + 0.60f * t, right = 0.62f - 0.60f * t;
    add_quad(mesh, {{left, y, 1.1f}, {right, y, 1.1f}, {right, y + 0.007f, 1.1f}, {left, y + 0.007f, 1.1f}});
  }
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh sky, glow, sun;
  add_quad(sky, {{-9, -1, -1}, {9, -1, -1}, {9, 1.5f, -1}, {-9, 1.5f, -1}}, {0.95f, 0.55f, 0.26f},
           {0.13f, 0.24f, 0.50f});
  add_disc(glow, {0.27f, 0.30f, -0.6f}, 0.335f);
  add_disc(sun, {0.27f, 0.30f, -0.5f}, 0.30f);
  add_part(scene, unlit("sky", {1, 1, 1}), std::move(sky));
  add_part(scene, unlit("rim", {6, 4, 1.6f}), std::move(glow));
  add_part(scene, unlit("sun", {120, 100, 60}), std::move(sun));
  add_part(scene, unlit("house", {0.030f, 0.018f, 0.016f}), make_house());
  add_part(scene, unlit("tiles", {0.075f, 0.040f, 0.032f}), make_tiles());
  scene.cameras.push_back(flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace sun_roof_scene

BuiltinMaker builtin_sun_roof() {
  return {
      "sun-roof",
      "the sun, 120 times white, behind a dark roof",
      {},
      sun_roof_scene::make,
      "HDR edges",
      "Edges before very bright light stay jagged under multisampling: godot issue 59965, Unity Graphics issue 1839."};
}

}  // namespace zoneplate
