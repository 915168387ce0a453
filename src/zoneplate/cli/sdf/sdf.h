// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace zoneplate::cli {

// The subcommands of `zoneplate sdf`. Each takes the arguments after its name, as a verb does.

void run_sdf_draw(std::span<const std::string> arguments);
void run_sdf_field(std::span<const std::string> arguments);
void run_sdf_from_mask(std::span<const std::string> arguments);
void run_sdf_to_mask(std::span<const std::string> arguments);
void run_sdf_text(std::span<const std::string> arguments);
void run_sdf_atlas(std::span<const std::string> arguments);

}  // namespace zoneplate::cli
