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

/// Evaluates an animation and overwrites the changed properties in `poses`: STEP, LINEAR (rotations along the shorter
/// great circle) and CUBICSPLINE.
///
/// Units     seconds; before the first and after the last key of a channel, the value of that key applies.
/// Exact     + - × / √ and math/elementary.h only, in float.
/// Errors    ErrorKind::Input naming animation and sampler: times that are not increasing, too few values, unknown
///           words.
void pose_nodes(GltfFile& file, std::size_t animation, double time, GltfPoses& poses);

}  // namespace zoneplate
