// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/obj/chunk.h"

namespace zoneplate {

/// The contents of an OBJ file. Indices are zero-based and validated; -1 means none.
struct ObjFile {
  std::vector<float3> positions;  ///< as in the file, relative to `origin`, and therefore not always finite
  double3 origin;                 ///< Scene::origin
  /// As many as positions, or empty; sRGB codes as in the file, white for positions without colour.
  std::vector<float4> colors;
  std::vector<float2> uvs;        ///< finite; origin at the bottom left
  std::vector<float3> normals;    ///< unit vectors, or zero for normals that are zero or not finite in the file
  bool has_odd_position = false;  ///< a position is not finite
  bool has_odd_normal = false;    ///< a normal is zero
  std::vector<ObjChunk> chunks;
};

/// Parses the statements of an OBJ file, in parallel. `done` is called with each part of the text that is not needed
/// for the time being.
///
/// Edges     a missing texture coordinate or normal is omitted from the corner, with a note.
/// Errors    ErrorKind::Input naming file, line and cause: a word that is not a number, too few numbers, the index of a
///           missing vertex.
ObjFile parse_obj(
    std::string_view text, ImportBudget& budget,
    const std::function<void(std::string_view)>& done = [](std::string_view) {});

}  // namespace zoneplate
