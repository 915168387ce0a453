// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/shade/shadow/shadows.h"

namespace zoneplate {

/// The values of --shadows and --ambient-occlusion, such as `soft:samples=64`.
/// Errors    ErrorKind::Usage for an unknown method or parameter.
ShadowOptions parse_shadows(const std::string& text);
OcclusionOptions parse_occlusion(const std::string& text);

}  // namespace zoneplate
