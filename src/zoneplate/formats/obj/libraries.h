// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/obj/layout.h"

namespace zoneplate {

/// Adds the materials of a layout to the folder's scene, as the libraries that it names define them.
///
/// Edges     a library that is missing and a material that none defines give a warning.
/// Errors    ErrorKind::Input if the budget's memory or time is exceeded.
void add_obj_materials(const ObjLayout& layout, ModelFolder& folder);

}  // namespace zoneplate
