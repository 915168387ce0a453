// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/job/option/option.h"

namespace zoneplate {

/// The option --tone-mapping, which sets `mapping`; `otherwise` is the end of its meaning: "default none".
Option tone_mapping_option(std::optional<ToneMapping>& mapping, const std::string& otherwise, const std::string& group);

/// The factor of the value of --exposure, in stops; nothing for "auto".
/// Errors    ErrorKind::Usage for another text.
std::optional<float> parse_exposure(const std::string& text);

}  // namespace zoneplate
