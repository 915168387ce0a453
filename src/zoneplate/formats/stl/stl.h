// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads an STL file, binary or ASCII; its bytes determine which.
///
/// Triangles are flat: their normals are computed from their corners, those of the file are ignored. Each solid of an
/// ASCII file is an object; a loop of more than three vertices is triangulated. Colours of binary files are read in
/// both conventions (sRGB-encoded, 5 bits): that of VisCAM and SolidView, and that of Materialise Magics, which is
/// recognised by "COLOR=" in the header, whose colour all facets have if all attributes are 0. All surfaces are
/// double-sided.
///
/// Space     Scene::up is +Z, as is usual for STL files.
/// Edges     triangles that are not finite, and bytes after the last triangle, are dropped with a warning.
/// Exact     the same scene, to the bit, for any number of threads.
/// Errors    ErrorKind::Input, one line naming file, place and cause.
Scene load_stl(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
