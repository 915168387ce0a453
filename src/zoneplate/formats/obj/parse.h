// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
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

/// The text of a file, cut after line ends into parts of some 1 MB, independently of the number of threads.
struct ObjText {
  char separator = '\n';  ///< of lines; '\r' in a text without '\n'
  std::vector<std::string_view> parts;
};

/// `done` is called with each part that is not needed for the time being.
///
/// Errors    ErrorKind::Input naming `file` for text in UTF-16.
ObjText cut_obj(
    std::span<const std::uint8_t> bytes, const std::string& file,
    const std::function<void(std::string_view)>& done = [](std::string_view) {});

/// Reads the parts of a text, in parallel, and those again that depend on others. `keep` takes each part that is read,
/// and may reduce it; `done` is called with each part of the text that is not needed for the time being. Returns the
/// numbers before each part and in all.
///
/// Errors    those of parse_obj.
std::vector<ObjCounts> read_obj_parts(const ObjText& text, ImportBudget& budget,
                                      const std::function<void(std::string_view)>& done,
                                      const std::function<void(std::size_t, ObjPart&)>& keep,
                                      std::vector<ObjPart>& parts);

/// Adds the warnings about what the chunks of a file have and is not drawn.
///
/// Errors    ErrorKind::Input with the text of the first one about a corner, if the limits are strict.
void report_obj_notes(const ObjFile& file, const ImportBudget& budget, std::vector<std::string>& warnings);

/// Parses the statements of an OBJ file, in parallel. `done` is called with each part of the text that is not needed
/// for the time being.
///
/// Edges     a missing texture coordinate or normal is omitted from the corner, with a note.
/// Errors    ErrorKind::Input naming file, line and cause: a word that is not a number, too few numbers, the index of a
///           missing vertex.
ObjFile parse_obj(
    const ObjText& text, ImportBudget& budget,
    const std::function<void(std::string_view)>& done = [](std::string_view) {});

}  // namespace zoneplate
