// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"

namespace zoneplate {

/// Opens a binary STL file to read its triangles in parts; null if it is ASCII.
///
/// Errors    those of load_stl about the number of facets.
std::unique_ptr<FileStream> open_stl_stream(const std::string& path, const LoadLimits& limits);

}  // namespace zoneplate
