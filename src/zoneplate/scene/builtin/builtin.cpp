// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/builtin/builtin.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {
namespace {

/// The maker named by a text, and the values of its parameters; nothing if no scene has that name.
std::optional<Spec<BuiltinMaker>> find_spec(std::string_view text) {
  if (!find_row(builtin_makers(), text)) return std::nullopt;
  return parse_spec("scene", builtin_makers(), text);
}

}  // namespace

std::span<const BuiltinScene> builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = [] {
    std::vector<BuiltinScene> list;
    for (const BuiltinMaker& maker : builtin_makers()) {
      std::string params;
      for (const Param& p : maker.params) params += fmt::format("{}{}={}", params.empty() ? "" : ",", p.name, p.value);
      list.push_back({maker.name, maker.summary, params, maker.failure, maker.complaint});
    }
    return list;
  }();
  return scenes;
}

const BuiltinScene* find_builtin_scene(std::string_view text) { return find_row(builtin_scenes(), text); }

bool check_builtin_scene(const std::string& text) { return find_spec(text).has_value(); }

std::optional<Scene> make_builtin_scene(const std::string& text) {
  const auto spec = find_spec(text);
  if (!spec) return std::nullopt;
  return spec->row.make(spec->settings.units());
}

Camera camera_at(float3 eye, float3 target, float vertical_fov, float near, float far) {
  const float3 forward = normalize(target - eye), right = normalize(cross(forward, {0, 1, 0}));
  const float3 above = cross(right, forward);
  Camera camera;
  camera.name = "camera";
  camera.world_from_camera = {{float4{right.x, right.y, right.z, 0}, float4{above.x, above.y, above.z, 0},
                               float4{-forward.x, -forward.y, -forward.z, 0}, float4{eye.x, eye.y, eye.z, 1}}};
  camera.vertical_fov = vertical_fov;
  camera.near = near, camera.far = far;
  return camera;
}

void add_object(Scene& scene, const char* name, Mesh mesh) {
  mesh.name = name;
  scene.instances.push_back(
      {static_cast<int>(scene.meshes.size()), static_cast<int>(scene.objects.size()), float4x4{}});
  scene.objects.push_back(name);
  scene.meshes.push_back(std::move(mesh));
}

}  // namespace zoneplate
