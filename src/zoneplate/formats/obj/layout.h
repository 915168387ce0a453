// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/formats/obj/normals.h"
#include "zoneplate/formats/obj/parse.h"

namespace zoneplate {

/// The elements of a file grouped by object, material and smoothing, in the order of the file.
struct ObjLayout {
  std::vector<ObjRun> runs;
  std::vector<std::string> objects;    ///< names, in the order of their first elements
  std::vector<std::string> materials;  ///< likewise; "" means no material
  std::vector<std::string> libraries;  ///< the operands of each mtllib statement
};

/// Groups the elements. Objects are named by `o`; in a file without any `o`, by `g`. Elements before the first such
/// statement belong to the object `unnamed`.
///
/// Errors    ErrorKind::Input if the budget's memory or time is exceeded.
ObjLayout lay_out(const ObjFile& file, const std::string& unnamed, ImportBudget& budget);

}  // namespace zoneplate
