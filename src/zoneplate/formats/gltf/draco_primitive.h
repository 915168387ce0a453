// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/formats/gltf/file.h"

namespace zoneplate {

/// Decodes a primitive's KHR_draco_mesh_compression, if it has one, and stores the values of its accessors in the file.
///
/// Errors    ErrorKind::Input naming the primitive (formats/gltf/draco.h).
void decode_draco_primitive(GltfFile& file, const JsonView& primitive);

}  // namespace zoneplate
