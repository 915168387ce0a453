// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/base/spec.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The maker of a built-in scene. The values of the parameters are in their order and in units of their last decimals
/// (Settings::units), so that the text is converted without rounding.
struct BuiltinMaker {
  const char* name;
  const char* summary;
  std::span<const Param> params;
  Scene (*make)(std::span<const std::int64_t> values);
  const char* failure = "";    ///< the class of artifacts in the scene
  const char* complaint = "";  ///< a description of the artifact, and the source of a user's report
};

/// The catalogue, in the order of makers.txt.
std::span<const BuiltinMaker> builtin_makers();

/// A camera at `eye` that looks at `target`, with the up direction +Y.
Camera camera_at(float3 eye, float3 target, float vertical_fov, float near, float far);

/// Adds a mesh as a separate object, with an identity transform.
void add_object(Scene& scene, const char* name, Mesh mesh);

}  // namespace zoneplate
