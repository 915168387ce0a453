// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"

namespace zoneplate {

/// Whether what a PLY file draws may need more memory than the limits. Of ASCII, this is estimated from its size.
///
/// Errors    those of load_ply about the header.
bool ply_may_exceed_memory(const std::string& path, const LoadLimits& limits);

/// Opens a PLY file to read its triangles in parts. Null if its faces are not plain triangles: one list, of three
/// 32-bit indices in a binary file. Of ASCII also if it has other elements, or values that its header does not state;
/// the whole text is read once.
///
/// Textures, colours that are not bytes and vertices that are not opaque cannot be read in parts (FileStream::check).
/// Errors    those of load_ply about the header.
std::unique_ptr<FileStream> open_ply_stream(const std::string& path, const LoadLimits& limits);

}  // namespace zoneplate
