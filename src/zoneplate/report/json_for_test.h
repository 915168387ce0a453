// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace zoneplate {

/// JSON that the program wrote, read by a library that is not ours. (Compiled once: the parser takes long to build.)
nlohmann::json parsed_json(std::string_view text);

}  // namespace zoneplate
