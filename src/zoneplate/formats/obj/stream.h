// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"

namespace zoneplate {

/// Whether what an OBJ file draws may need more memory than the limits: estimated from samples of its text.
bool obj_may_exceed_memory(const std::string& path, const LoadLimits& limits);

/// Opens an OBJ file to read its triangles in parts; null if it has no faces. Reads the whole file once.
///
/// Lines and points, faces without normals among those that have them, and materials that need tangents or heights,
/// cannot be read in parts (FileStream::check). The images of textures are in memory.
/// Errors    those of load_obj.
std::unique_ptr<FileStream> open_obj_stream(const std::string& path, const LoadLimits& limits);

}  // namespace zoneplate
