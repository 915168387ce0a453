// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads a Wavefront OBJ file with its MTL libraries (Blinn-Phong materials, or metallic-roughness for PBR keys).
///
/// Each object has one mesh per material; objects are named by `o`, or by `g` in a file without any `o`. Polygons
/// become triangles, polylines lines; a file that has only vertices is a point cloud. Missing normals are smooth within
/// a smoothing group and flat where smoothing is off; a file without `s` statements is smooth across edges that bend by
/// less than 50°. Vertex colours after the coordinates are sRGB codes. Materials: formats/obj/mtl_material.h.
///
/// Edges     elements with a vertex that is not finite are dropped; ignored content (unknown statements, free-form
///           geometry, missing libraries, materials and images) gives a warning that names it.
/// Exact     the same scene, to the bit, for any number of threads.
/// Errors    ErrorKind::Input, one line naming file, line and cause.
Scene load_obj(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
