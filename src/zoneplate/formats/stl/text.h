// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// Parses an ASCII STL file, in parallel. Words are separated by any white space and are case-insensitive; comments are
/// as for find_stl_solid. The name of a solid ends with its line, or before "facet normal".
///
/// Vertices are relative to `origin`, which is subtracted in double before they are rounded to floats.
///
/// Errors    ErrorKind::Input naming file, line and cause: an unknown word, a word that is not a number.
StlText parse_stl_text(std::string_view text, ImportBudget& budget, double3 origin = {});

}  // namespace zoneplate
