// SPDX-License-Identifier: Apache-2.0
// A cable-stayed bridge: oblique lines about a pixel wide, at all angles between steep and flat.
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace thin_diagonal_scene {
namespace {

Mesh make_cables() {
  Mesh mesh;
  for (const float tower : {-0.62f, 0.62f})
    for (int i = 1; i <= 15; ++i) {
      const float t = static_cast<float>(i), high = -0.30f + 0.066f * t;
      for (const float way : {-1.0f, 1.0f})
        add_bar(mesh, {tower, high, 0}, {tower + way * 0.0405f * t, -0.395f, 0}, 0.0023f - 0.00007f * t, 6);
    }
  return mesh;
}

Mesh make_bridge() {
  Mesh mesh;
  for (const float tower : {-0.62f, 0.62f}) {
    add_quad(mesh, {{tower - 0.030f, -1.5f, 0.1f},
                    {tower + 0.030f, -1.5f, 0.1f},
                    {tower + 0.010f, 0.74f, 0.1f},
                    {tower - 0.010f, 0.74f, 0.1f}});
    add_quad(mesh, {{tower - 0.05f, -0.46f, 0.1f},
                    {tower + 0.05f, -0.46f, 0.1f},
                    {tower + 0.05f, -0.42f, 0.1f},
                    {tower - 0.05f, -0.42f, 0.1f}});
  }
  add_quad(mesh, {{-9, -0.44f, 0.05f}, {9, -0.44f, 0.05f}, {9, -0.395f, 0.05f}, {-9, -0.395f, 0.05f}});
  return mesh;
}

/// The railing, and the truss below the deck.
Mesh make_truss() {
  Mesh mesh;
  constexpr int parts = 90;
  for (int i = -parts; i < parts; ++i) {
    const float a = 0.05f * static_cast<float>(i), b = a + 0.05f;
    add_bar(mesh, {a, -0.44f, 0}, {b, -0.52f, 0}, 0.0022f);
    add_bar(mesh, {b, -0.44f, 0}, {a, -0.52f, 0}, 0.0022f);
  }
  add_bar(mesh, {-4.5f, -0.52f, 0}, {4.5f, -0.52f, 0}, 0.004f);
  add_bar(mesh, {-4.5f, -0.372f, 0}, {4.5f, -0.372f, 0}, 0.0018f);
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh sky, water;
  add_quad(sky, {{-9, -0.66f, -1}, {9, -0.66f, -1}, {9, 1.2f, -1}, {-9, 1.2f, -1}}, {0.42f, 0.30f, 0.30f},
           {0.03f, 0.07f, 0.20f});
  add_quad(water, {{-9, -2, -1}, {9, -2, -1}, {9, -0.66f, -1}, {-9, -0.66f, -1}}, {0.01f, 0.02f, 0.04f},
           {0.10f, 0.09f, 0.11f});
  add_part(scene, unlit("sky", {1, 1, 1}), std::move(sky));
  add_part(scene, unlit("water", {1, 1, 1}), std::move(water));
  add_part(scene, unlit("cables", {0.92f, 0.90f, 0.84f}), make_cables());
  add_part(scene, unlit("bridge", {0.70f, 0.66f, 0.60f}), make_bridge());
  add_part(scene, unlit("truss", {0.50f, 0.16f, 0.09f}), make_truss());
  scene.cameras.push_back(flat_camera(0.86f));
  return scene;
}

}  // namespace
}  // namespace thin_diagonal_scene

BuiltinMaker builtin_thin_diagonal() {
  return {"thin-diagonal",
          "a bridge's cables: oblique lines of about a pixel",
          {},
          thin_diagonal_scene::make,
          "thin diagonals",
          "Fine oblique geometry is broken up, or not found at all: pmndrs/postprocessing issue 290."};
}

}  // namespace zoneplate
