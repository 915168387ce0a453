#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/scene/light.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/scene/mesh.h"
#include "zoneplate/scene/name_list.h"

namespace ZONEPLATE_API zoneplate {

/// One placement of a mesh in the world. Meshes of one node share its `object` number.
struct Instance {
  int mesh = 0;
  int object = 0;  ///< index into Scene::objects
  float4x4 world_from_object;
};

/// An animation of a file, and when it runs.
struct AnimationSpan {
  std::string name;
  float begin = 0, end = 0;  ///< in seconds
};

/// Everything that a picture is made of, flat: no hierarchy is left.
///
/// Requires  every index is in range; `materials` is not empty when there are meshes.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  NameList objects;  ///< names, for ids
  std::vector<Material> materials;
  std::vector<TextureImage> images;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Environment environment;
  float3 up{0, 1, 0};             ///< the upward axis that the file's format means; the camera takes it from here
  float3 ambient_light{0, 0, 0};  ///< of (Blinn-)Phong's ambient term, of which surfaces reflect Material::ambient
  std::vector<AnimationSpan> animations;  ///< that the file has
  std::vector<std::string> variants;      ///< likewise, of materials
  std::vector<std::string> warnings;      ///< what was passed over at load, one line each

  /// The world-space bounds of all instances (only of vertices that a primitive uses).
  Box bounds() const;
};

}  // namespace zoneplate
