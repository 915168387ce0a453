#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/scene/camera.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/scene/light.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/scene/mesh.h"
#include "zoneplate/scene/name_list.h"

namespace zoneplate {

/// An instance of a mesh in the world. Meshes of one node share its `object` index.
struct Instance {
  int mesh = 0;
  int object = 0;  ///< index into Scene::objects
  float4x4 world_from_object;
};

/// An animation of a file, and its time span.
struct AnimationSpan {
  std::string name;
  float begin = 0, end = 0;  ///< in seconds
};

/// All data of a scene, without hierarchy.
///
/// Requires  every index is in range; `materials` is not empty when there are meshes.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  NameList objects;  ///< names of objects, for ids
  std::vector<Material> materials;
  std::vector<TextureImage> images;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Environment environment;
  float3 up{0, 1, 0};                     ///< the up axis of the file's format, for the camera
  float3 ambient_light{0, 0, 0};          ///< of (Blinn-)Phong's ambient term; multiplied by Material::ambient
  std::vector<AnimationSpan> animations;  ///< of the file
  std::vector<std::string> variants;      ///< material variants of the file
  std::vector<std::string> warnings;      ///< what the loader ignored, one line each

  /// The world-space bounds of all instances (only of vertices that a primitive uses).
  Box bounds() const;
};

/// The scene, material variant and time to be loaded from a file (glTF).
struct SceneChoice {
  static constexpr int all_animations = -1;
  std::optional<int> scene;      ///< index into the file's scenes; none: the file's default scene
  std::string variant;           ///< of KHR_materials_variants; empty: the default materials
  std::optional<int> animation;  ///< index into the file's animations, or all of them; none: not animated
  double time = 0;               ///< of the animation, in seconds; clamped to its time span
};

/// Limits on the resources of a loader.
struct LoadLimits {
  std::uint64_t memory = std::uint64_t{4} << 30;  ///< bytes of decoded scene data (--max-memory)
  std::uint64_t pixels = std::uint64_t{1} << 28;  ///< of one image (--max-pixels)
  double seconds = 60;                            ///< for one import
  int node_depth = 256;
  /// Files, and folders with all below them, that a model may use in addition to its own folder (--allow-path).
  std::vector<std::string> allowed_paths = {};
};

}  // namespace zoneplate
