// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/base/spec.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// How a built-in scene is made. The values of the parameters arrive in their order and in units of their last decimals
/// (Settings::units), so that no rounding comes between the text and the scene.
struct BuiltinMaker {
  const char* name;
  const char* summary;
  std::span<const Param> params;
  Scene (*make)(std::span<const std::int64_t> values);
  const char* failure = "";    ///< the class of artifacts that the scene shows
  const char* complaint = "";  ///< a description of the artifact, and the source of a user's report
};

/// The catalogue, in the order of makers.txt.
std::span<const BuiltinMaker> builtin_makers();

/// A camera at `eye` that looks at `target`, upright.
Camera camera_at(float3 eye, float3 target, float vertical_fov, float near, float far);

/// Adds a mesh as an object of its own, placed where it is.
void add_object(Scene& scene, const char* name, Mesh mesh);

}  // namespace zoneplate
