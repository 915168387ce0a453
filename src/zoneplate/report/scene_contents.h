// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/report/json.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The contents of a scene, as `zoneplate info --json` prints them after the name of the input.
Json::Object scene_contents(const Scene& scene);

/// The same as lines of text, the output of `zoneplate info` after the name of the input.
std::string scene_contents_text(const Scene& scene);

}  // namespace zoneplate
