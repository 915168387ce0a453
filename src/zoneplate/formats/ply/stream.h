// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"

namespace zoneplate {

/// Opens a binary PLY file to read its triangles in parts. Null if it is ASCII, or if its faces are not plain
/// triangles: one list, of three 32-bit indices.
///
/// Textures, colours that are not bytes and vertices that are not opaque cannot be read in parts (FileStream::check).
/// Errors    those of load_ply about the header.
std::unique_ptr<FileStream> open_ply_stream(const std::string& path, const LoadLimits& limits);

}  // namespace zoneplate
