// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/os/run_program.h"

namespace zoneplate {

/// As run_child (os/run_program.h), with a file of these contents as stdin, which the program may open as /dev/stdin
/// and read in any order.
ProgramResult run_on_file(const std::string& program, const std::vector<std::string>& arguments,
                          std::span<const std::uint8_t> file, const ProgramLimits& limits = {});

}  // namespace zoneplate
