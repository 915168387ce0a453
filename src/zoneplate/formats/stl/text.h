// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The content of an ASCII STL file: loops of vertices, and the beginnings of solids.
struct StlText {
  struct Solid {
    std::uint64_t before;  ///< the loop before which it stands
    std::string name;
  };
  std::vector<float3> vertices;
  std::vector<std::uint64_t> loops;  ///< where each begins; one entry more at the end
  std::vector<Solid> solids;
};

/// Reads an ASCII STL file, in parallel. Words are separated by any white space, their case does not matter.
///
/// Errors    ErrorKind::Input naming file, line and cause: a word that is not known, a number that is none.
StlText parse_stl_text(std::string_view text, ImportBudget& budget);

}  // namespace zoneplate
