// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/cli/signal/args.h"
#include "zoneplate/imaging/sdf/shape_scene.h"
#include "zoneplate/imaging/sdf/show_field.h"

namespace zoneplate::cli {

/// --size, --scale and --font.
std::vector<Option> shape_scene_options(ShapeSceneOptions& args);

/// The options --show and --spacing, which set `args`; `unit` names the field's unit in the help.
std::vector<Option> field_view_options(FieldViewArgs& args, const std::string& unit);

/// The paragraphs of the help about the language of scenes.
std::string shape_scene_notes();

}  // namespace zoneplate::cli
