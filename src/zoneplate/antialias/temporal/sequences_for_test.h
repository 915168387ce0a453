// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate::antialias {

/// A scene and its camera at every frame.
struct MovingScene {
  std::function<Scene(int)> scene;
  std::function<Camera(int)> camera;
  int width = 96, height = 64;

  RenderSettings settings() const { return {.options = {.width = width, .height = height}, .form = ImageForm::Linear}; }
};

/// A scene at rest, with lights.
inline MovingScene still(Scene scene) {
  light_unlit(scene);
  MovingScene moving{[scene](int) { return scene; }, {}};
  const float aspect = static_cast<float>(moving.width) / static_cast<float>(moving.height);
  const Camera camera = scene.cameras.empty() ? choose_camera(scene, {}, aspect) : scene.cameras[0];
  moving.camera = [camera](int) { return camera; };
  return moving;
}

/// All frames of a sequence, before tone mapping.
inline std::vector<LinearImage> film(const MovingScene& moving, const std::string& method, int frames,
                                     const RenderSettings& settings) {
  PreparedScene prepared(moving.scene(0));
  Renderer renderer(prepared, make_resolver(methods(), method));
  std::vector<LinearImage> out;
  for (int i = 0; i < frames; ++i) {
    if (i > 0) renderer.set_scene(PreparedScene(moving.scene(i), prepared));
    out.push_back(renderer.render(moving.camera(i), settings).linear);
  }
  return out;
}
inline std::vector<LinearImage> film(const MovingScene& moving, const std::string& method, int frames) {
  return film(moving, method, frames, moving.settings());
}

inline LinearImage last_frame(const MovingScene& moving, const std::string& method, int frames) {
  return std::move(film(moving, method, frames).back());
}

/// Root mean square difference of the colours.
inline double rms(const LinearImage& a, const LinearImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const Linear &p = a.values()[i], &q = b.values()[i];
    for (const double d : {double{p.r} - q.r, double{p.g} - q.g, double{p.b} - q.b}) sum += d * d;
  }
  return std::sqrt(sum / (3 * static_cast<double>(a.values().size())));
}

/// A wall of one colour with a square before it, seen by an orthographic camera of 1/32 unit per pixel. The square is
/// 20 pixels wide; `place` is its centre in pixels from the image's.
inline MovingScene square_before_wall(std::function<float2(int)> place) {
  const auto quad = [](float x, float y, float half, float z) {
    Mesh mesh;
    add_quad(mesh,
             {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}});
    return mesh;
  };
  return {[=](int i) {
            Scene scene;
            add_part(scene, unlit("wall", {0.25f, 0.3f, 0.2f}), quad(0, 0, 64, -4));
            add_part(scene, unlit("square", {0.75f, 0.5f, 0.375f}), quad(0, 0, 10 / 32.0f, -2));
            const float2 p = place(i);
            scene.instances[1].world_from_object = translation(float3{p.x / 32, p.y / 32, 0});
            return scene;
          },
          [](int) { return flat_camera(1); }};
}

}  // namespace zoneplate::antialias
