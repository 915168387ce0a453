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
  std::vector<std::string> objects;    ///< names, in the order in which they get their first element
  std::vector<std::string> materials;  ///< likewise; "" is no material
  std::vector<std::string> libraries;  ///< the operands of each mtllib statement
};

/// Objects are those of `o`; in a file without any `o`, the groups of `g`. What comes before the first is `unnamed`.
///
/// Errors    ErrorKind::Input when memory or time of the budget run out.
ObjLayout lay_out(const ObjFile& file, const std::string& unnamed, ImportBudget& budget);

}  // namespace zoneplate
