// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"

namespace zoneplate {

/// Whether what an STL file draws may need more memory than the limits. Of ASCII, this is estimated from its size.
bool stl_may_exceed_memory(const std::string& path, const LoadLimits& limits);

/// Opens an STL file to read its triangles in parts; null if it is ASCII without a triangle. Reads all of ASCII once.
///
/// Errors    those of load_stl about the number of facets, or about words.
std::unique_ptr<FileStream> open_stl_stream(const std::string& path, const LoadLimits& limits);

}  // namespace zoneplate
