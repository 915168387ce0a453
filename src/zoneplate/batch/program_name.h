// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate {

/// The version and the commit of this program: "1.2.0 0123456789ab". Programs of one name make the same files.
std::string program_name();

}  // namespace zoneplate
