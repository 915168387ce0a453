// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads a PLY file: ASCII, or binary of either byte order; properties of any type in any order.
///
/// Faces with any number of corners and strips become triangles. Edges become lines if there are no faces; a file that
/// has only vertices is a point cloud. Supported attributes are normals, colours (of vertices or faces), texture
/// coordinates (of vertices, or MeshLab's of faces) and MeshLab's comment that names a texture. Missing normals are
/// smooth across edges that bend by less than 50° (scene/geometry/smooth_normals.h). All surfaces are double-sided.
///
/// Edges     primitives with a vertex that is not finite are dropped, with a warning; other elements and properties are
///           ignored.
/// Exact     the same scene, to the bit, for any number of threads.
/// Errors    ErrorKind::Input, one line naming file, place and cause.
Scene load_ply(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
