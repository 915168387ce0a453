// SPDX-License-Identifier: Apache-2.0
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

#pragma GCC visibility push(default)
namespace zoneplate {

/// An instance of a mesh in the world. Meshes of one node share its `object` index.
///
/// Object and part identify an instance at all moments of an animation: its index in Scene::instances changes where
/// another one appears or vanishes.
struct Instance {
  int mesh = 0;                  ///< index into Scene::meshes
  int object = 0;                ///< index into Scene::objects
  float4x4 world_from_object{};  ///< affine; the identity by default
  int part = 0;                  ///< which of the object's meshes it is; may be 0 for all where none vanishes
};

/// An animation of a file, and its time span.
struct AnimationSpan {
  std::string name{};        ///< of the file; may be empty
  float begin = 0, end = 0;  ///< in seconds
};

/// All data of a scene, without hierarchy.
///
/// Space     world space is that of the file, moved by -origin. The origin is 0 unless the scene lies farther from the
///           file's origin than 64 times its own size, as maps and surveys do: there, floats would round the places of
///           its points. A place p of the world has the coordinates origin + p in the file. Functions with files,
///           options and other programs use the coordinates of the file; all of the library uses world space.
/// Requires  every index is in range; `materials` is not empty when there are meshes.
struct Scene {
  std::vector<Mesh> meshes{};          ///< drawn where instances place them
  std::vector<Instance> instances{};   ///< in this order: of equal depths the first drawn is visible
  NameList objects{};                  ///< names of objects, for ids; also of those that are hidden at the moment
  std::vector<Material> materials{};   ///< Mesh::material is an index into this list
  std::vector<TextureImage> images{};  ///< TextureUse::image is an index into this list
  std::vector<Light> lights{};         ///< none: see light_unlit
  std::vector<Camera> cameras{};       ///< of the file; View::index chooses one
  Environment environment{};           ///< light from infinitely far away
  double3 origin{};                    ///< of world space, in the coordinates of the file; 0 for a scene near theirs
  float3 up{0, 1, 0};                  ///< the up axis of the file's format, for the camera
  float3 ambient_light{0, 0, 0};  ///< of (Blinn-)Phong's ambient term, times Material::ambient; with an environment
                                  ///< of one colour, zero stands for that colour
  bool needs_fill_light = false;  ///< the lights are those of a file, and where they do not reach, all is black
  std::vector<AnimationSpan> animations{};  ///< of the file
  std::vector<std::string> variants{};      ///< material variants of the file
  std::vector<std::string> warnings{};      ///< what the loader ignored, one line each

  /// The coordinates in the file of a place of the world.
  double3 in_file(float3 place) const { return origin + widened(place); }
  /// The place in the world of coordinates in the file.
  float3 in_world(double3 coordinates) const { return narrowed(coordinates - origin); }

  /// The world-space bounds of all instances (only of vertices that a primitive uses).
  Box bounds() const;
};

}  // namespace zoneplate
#pragma GCC visibility pop
