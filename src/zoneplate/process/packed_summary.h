// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/job/summary.h"

namespace zoneplate {

/// Serializes the summary for the parent process.
std::vector<std::uint8_t> pack_summary(const Summary& summary);

/// Errors    ErrorKind::Failed if the bytes end early.
Summary unpack_summary(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
