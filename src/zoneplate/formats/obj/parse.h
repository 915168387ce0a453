// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/obj/chunk.h"

namespace zoneplate {

/// The contents of an OBJ file before they become meshes. Indices are zero-based and validated; -1 is none.
struct ObjFile {
  std::vector<float3> positions;  ///< not finite if the file's values are not
  std::vector<float4> colors;     ///< as long as positions, or empty; codes as in the file, white where it has none
  std::vector<float2> uvs;        ///< finite; origin at the bottom left
  std::vector<float3> normals;    ///< of unit length, or zero where the file's is zero or not finite
  bool has_odd_position = false;  ///< one that is not finite
  bool has_odd_normal = false;    ///< one that is zero
  std::vector<ObjChunk> chunks;
};

/// Reads the statements of an OBJ file, in parallel. `done` is called with each part of the text that is not needed for
/// the moment.
///
/// Edges     a corner that names a texture coordinate or normal that is not there has none, with a note.
/// Errors    ErrorKind::Input naming file, line and cause: a number that is none, too few numbers, a vertex that is not
///           there.
ObjFile parse_obj(
    std::string_view text, ImportBudget& budget,
    const std::function<void(std::string_view)>& done = [](std::string_view) {});

}  // namespace zoneplate
