// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace zoneplate {

/// A number of bytes for messages, in the units of options: "1 byte", "900 bytes", "1.5 kB", "60 MB", "4 GB", of 1024
/// each.
std::string size_text(std::uint64_t bytes);

}  // namespace zoneplate
