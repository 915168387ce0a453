// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The contents of an ASCII STL file: loops of vertices, grouped into solids.
struct StlText {
  struct Solid {
    std::uint64_t before;  ///< the index of the solid's first loop
    std::string name;
  };
  std::vector<float3> vertices;
  std::vector<std::uint64_t> loops;  ///< the index of each loop's first vertex; one more element at the end
  std::vector<Solid> solids;
};

/// The offset of the word "solid" at the front of a text, behind a byte order mark, white space and lines of comments
/// (which begin with ';', '#' or "//"); npos if another word is there.
std::size_t find_stl_solid(std::string_view text);

/// The text from its first solid on, cut before facets into parts of some 1 MB. `done` is called with each part that is
/// not needed for the time being.
std::vector<std::string_view> cut_stl_text(
    std::string_view text, const std::function<void(std::string_view)>& done = [](std::string_view) {});

/// Parses one part of a text independently of the others.
///
/// Errors    those of parse_stl_text.
StlText parse_stl_part(std::string_view text, std::string_view part, const std::string& file);

/// Appends a solid, or replaces the last one if that has no loops.
void add_solid(std::vector<StlText::Solid>& solids, StlText::Solid solid);

/// Appends the corners of the triangles of the loops [begin, end), three each; of a loop with a vertex that is not
/// finite its first three vertices. Returns how many loops are too short for a triangle. It may stop when the time is
/// over.
std::uint64_t add_stl_triangles(const StlText& text, std::uint64_t begin, std::uint64_t end, const ImportBudget& budget,
                                std::vector<float3>& corners);

/// Parses an ASCII STL file, in parallel. Words are separated by any white space and are case-insensitive; comments are
/// as for find_stl_solid. The name of a solid ends with its line, or before "facet normal".
///
/// Vertices are relative to `origin`, which is subtracted in double before they are rounded to floats.
///
/// Errors    ErrorKind::Input naming file, line and cause: an unknown word, a word that is not a number.
StlText parse_stl_text(std::string_view text, ImportBudget& budget, double3 origin = {});

}  // namespace zoneplate
