// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

/// From now on this process may have `bytes` more of memory that it can write to than it has now, whoever allocates
/// it; past that, allocations fail. Files that FileBytes maps count. A later call replaces the limit.
///
/// For programs: the limit is the whole process's (RLIMIT_DATA), and passes to its children.
void limit_memory(std::uint64_t bytes);

}  // namespace zoneplate
