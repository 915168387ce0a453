#pragma once

#include <string>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads a Wavefront OBJ file with its MTL libraries (Blinn-Phong materials; PBR keys where the file has them).
///
/// n-gons are triangulated; missing normals are smooth within a smoothing group and flat where smoothing is off.
/// Errors    Trouble::Input, one line naming file, line and cause.
Scene load_obj(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
