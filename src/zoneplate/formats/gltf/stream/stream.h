// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"
#include "zoneplate/formats/import/load_options.h"

namespace zoneplate {

/// Whether what a scene of a glTF file draws may need more memory than the limits: decided by its JSON alone.
///
/// Errors    those of load_gltf about the JSON.
bool gltf_may_exceed_memory(const std::string& path, const LoadLimits& limits, const SceneChoice& choice);

/// Opens a scene of a glTF file to read its triangles in parts. Null if it has none, and for glTF 1.0.
///
/// Materials that need tangents, skins, morph targets, Draco, sparse accessors, other modes than 4 and a scene far from
/// its origin cannot be read in parts (FileStream::check). The images of textures, and what meshopt compresses, are in
/// memory.
/// Errors    those of load_gltf.
std::unique_ptr<FileStream> open_gltf_stream(const std::string& path, const LoadLimits& limits,
                                             const SceneChoice& choice = {});

}  // namespace zoneplate
