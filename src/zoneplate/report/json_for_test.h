// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace zoneplate {

/// Parses JSON written by the program with an independent library. (Compiled once, because the parser takes long to
/// compile.)
nlohmann::json parsed_json(std::string_view text);

}  // namespace zoneplate
