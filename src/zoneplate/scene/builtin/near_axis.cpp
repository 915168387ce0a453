// SPDX-License-Identifier: Apache-2.0
// Nearly horizontal and nearly vertical slats: at these angles the steps of an edge are longest.
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace near_axis_scene {
namespace {

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh wall, level, upright;
  add_quad(wall, {{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}}, {0.010f, 0.016f, 0.030f},
           {0.030f, 0.045f, 0.075f});
  constexpr int slats = 15;
  for (int k = 0; k < slats; ++k) {
    // From a fifth of a degree to three and a half degrees.
    const float rise = 0.004f * static_cast<float>(k + 1), at = -0.87f + 0.119f * static_cast<float>(k);
    constexpr float thick = 0.058f, begin = -1.23f, end = -0.03f;
    const float length = end - begin, share = static_cast<float>(k) / (slats - 1);
    const float3 color{0.85f, 0.72f - 0.35f * share, 0.50f - 0.32f * share};
    add_quad(
        level,
        {{begin, at, 0}, {end, at + rise * length, 0}, {end, at + rise * length + thick, 0}, {begin, at + thick, 0}},
        color, color);
    const float x = 0.06f + 0.076f * static_cast<float>(k), lean = rise * 1.74f;
    constexpr float wide = 0.040f, low = -0.87f, high = 0.87f;
    const float3 cool{0.45f - 0.30f * share, 0.70f - 0.2f * share, 0.85f};
    add_quad(upright, {{x, low, 0}, {x + wide, low, 0}, {x + wide + lean, high, 0}, {x + lean, high, 0}}, cool, cool);
  }
  add_part(scene, unlit("wall", {1, 1, 1}), std::move(wall));
  add_part(scene, unlit("level", {1, 1, 1}), std::move(level));
  add_part(scene, unlit("upright", {1, 1, 1}), std::move(upright));
  scene.cameras.push_back(flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace near_axis_scene

BuiltinMaker builtin_near_axis() {
  return {"near-axis",
          "slats a fifth of a degree to three and a half off level and upright",
          {},
          near_axis_scene::make,
          "near-axis edges",
          "Stairs that stay on nearly level edges: PCSX2 issue 997, KlayGE issue 80 (FXAA given up for SMAA)."};
}

}  // namespace zoneplate
