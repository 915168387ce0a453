// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads an STL file, binary or ASCII, as it is recognised by its bytes.
///
/// Triangles are flat: their normals follow from their corners, the file's own are not used. Each solid of an ASCII
/// file is an object; a loop of more than three vertices is cut into triangles. Colours of binary files are read in
/// both conventions (sRGB-encoded, 5 bits): VisCAM and SolidView's, and Materialise Magics', which is recognised by
/// "COLOR=" in the header. All surfaces are double-sided.
///
/// Space     Scene::up is +Z, as programs that write STL have it.
/// Edges     a triangle that is not finite is dropped, with a warning; so are bytes after the last triangle.
/// Exact     the same scene, to the bit, for any number of threads.
/// Errors    ErrorKind::Input, one line naming file, place and cause.
Scene load_stl(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
