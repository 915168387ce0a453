// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zoneplate {

/// What the module belongs to: "this page", "this package".
extern const std::string_view this_door;

/// Throws ErrorKind::Input: "PLACE: meshes packed by Draco are read by the program, not by this page".
[[noreturn]] void refuse(const std::string& place, std::string_view what);

}  // namespace zoneplate
