// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/program_name.h"

#include <fmt/format.h>

#include "zoneplate/commit.h"
#include "zoneplate/version.h"

namespace zoneplate {

std::string program_name() { return fmt::format("{} {}", version, commit); }

}  // namespace zoneplate
