// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "zoneplate/formats/import/file_stream.h"
#include "zoneplate/formats/load.h"

namespace zoneplate {

/// Opens a file whose scene might not fit into LoadLimits::memory, to read its triangles in parts: null if it surely
/// fits, for formats that are not read in parts, all but glTF, OBJ, binary STL and PLY of triangles, and where a child
/// process has to read it (LoadOptions::is_sandboxed).
///
/// Errors    those of load_scene about its header.
std::unique_ptr<FileStream> open_large_file(const std::string& name, const LoadOptions& options);

}  // namespace zoneplate
