// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace zoneplate::cli {

// The subcommands of `zoneplate texture`. Each takes the arguments after its name, as a verb does.

void run_texture_levels(std::span<const std::string> arguments);
void run_texture_normal_from_height(std::span<const std::string> arguments);

}  // namespace zoneplate::cli
