// SPDX-License-Identifier: Apache-2.0
// Power lines and a fence that become thinner than a pixel with distance.
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace wires_scene {
namespace {

constexpr int masts = 6;
constexpr float mast_height = 9, arm = 1.9f, wire_radius = 0.014f;

float3 mast_at(int i) {
  const auto t = static_cast<float>(i);
  return {-5.5f + 3.1f * t + 0.35f * t * t, 0, -9 - 13 * t};
}

Mesh make_masts() {
  Mesh mesh;
  for (int i = 0; i < masts; ++i) {
    const float3 p = mast_at(i);
    add_bar(mesh, p, p + float3{0, mast_height, 0}, 0.13f, 8);
    for (const float y : {mast_height - 0.6f, mast_height - 2.2f})
      add_box(mesh, {p.x - arm, y, p.z - 0.07f}, {p.x + arm, y + 0.14f, p.z + 0.07f});
  }
  return mesh;
}

Mesh make_wires() {
  Mesh mesh;
  for (int i = -1; i + 1 < masts; ++i)
    for (const float y : {mast_height - 0.6f, mast_height - 2.2f})
      for (const float x : {-arm + 0.1f, -0.75f, 0.75f, arm - 0.1f})
        add_wire(mesh, mast_at(i) + float3{x, y, 0}, mast_at(i + 1) + float3{x, y, 0}, 0.8f, wire_radius);
  return mesh;
}

/// Vertical rods between two rails, along a line that leads away from the viewer.
Mesh make_fence() {
  Mesh mesh;
  constexpr float3 from{1.55f, 0, -0.9f}, to{6.8f, 0, -46};
  constexpr int rods = 380;
  for (int i = 0; i <= rods; ++i) {
    const float3 p = from + (to - from) * (static_cast<float>(i) / rods);
    add_bar(mesh, p + float3{0, 0.12f, 0}, p + float3{0, 1.25f, 0}, 0.007f, 6);
  }
  for (const float y : {0.14f, 1.22f}) add_bar(mesh, from + float3{0, y, 0}, to + float3{0, y, 0}, 0.018f, 6);
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh sky, ground;
  add_quad(sky, {{-900, -40, -500}, {900, -40, -500}, {900, 420, -500}, {-900, 420, -500}}, {0.80f, 0.72f, 0.62f},
           {0.10f, 0.22f, 0.50f});
  add_quad(ground, {{-900, 0, 20}, {900, 0, 20}, {900, 0, -499}, {-900, 0, -499}}, {0.05f, 0.07f, 0.03f},
           {0.22f, 0.20f, 0.13f});
  add_part(scene, unlit("sky", {1, 1, 1}), std::move(sky));
  add_part(scene, unlit("ground", {1, 1, 1}), std::move(ground));
  add_part(scene, unlit("masts", {0.045f, 0.035f, 0.03f}), make_masts());
  add_part(scene, unlit("wires", {0.012f, 0.012f, 0.014f}), make_wires());
  add_part(scene, unlit("fence", {0.62f, 0.60f, 0.55f}), make_fence());
  scene.cameras.push_back(camera_at({0, 1.6f, 2}, {1.1f, 3.3f, -12}, 0.75f, 0.2f, 600));
  return scene;
}

}  // namespace
}  // namespace wires_scene

BuiltinMaker builtin_wires() {
  return {"wires",
          "power lines and a fence, thinner than a pixel far away",
          {},
          wires_scene::make,
          "sub-pixel wires and grates",
          "Thin lines and grates fall to pieces or are smeared away: DaemonEngine issue 1909."};
}

}  // namespace zoneplate
