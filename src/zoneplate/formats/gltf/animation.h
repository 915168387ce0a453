// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The pose of one node at one time; properties that the animation does not change are empty.
struct GltfNodePose {
  std::optional<float3> translation, scale;
  std::optional<Quaternion> rotation;
  std::vector<float> weights;  ///< weights of the morph targets
};

/// The poses of the nodes that an animation changes, by their indices in the file.
using GltfPoses = std::map<std::size_t, GltfNodePose>;

/// The names and time ranges of the file's animations.
std::vector<AnimationSpan> list_animations(GltfFile& file);

/// Evaluates an animation: adds the properties of nodes to `poses`, and sets those that KHR_animation_pointer names in
/// the file's JSON (GltfFile::edits). Values replace those of animations before. Interpolation is STEP, LINEAR
/// (rotations along the shorter great circle) or CUBICSPLINE.
///
/// Units     seconds; before the first and after the last key of a channel, the value of that key applies.
/// Exact     + - × / √ and math/elementary.h only, in float.
/// Errors    ErrorKind::Input naming animation and sampler: times that do not grow, too few values, unknown words.
void animate(GltfFile& file, std::size_t animation, double time, GltfPoses& poses);

}  // namespace zoneplate
