#pragma once

#include <string>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads a glTF 2.0 file, .gltf (with its buffers and images) or .glb, at its default scene.
///
/// Missing normals are flat, missing tangents (where a normal texture wants them) are MikkTSpace's, as the
/// specification says; strips, fans and loops become lists; a vertex that is not finite drops its primitives, with a
/// warning. Morph targets have their default weights and skins the pose of their joints' nodes.
///
/// Space     a camera's transform has no scale and no mirroring; lights likewise.
/// Errors    Trouble::Input, one line naming the file, the place and the cause; a required extension that is not
///           supported is named. An optional one gives a warning that names it.
Scene load_gltf(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
