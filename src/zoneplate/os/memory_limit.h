// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace zoneplate {

/// The limit that holds where `option`, by its name, sets one of `bytes`, for messages: "200 MB (--max-memory)", or
/// "300 MB (ulimit -v)" where this process has a lower limit of its own. Inside of a sandbox the option's.
std::string memory_limit_text(std::uint64_t bytes, const char* option);

/// Limits the writable memory of this process to `bytes` more than it has now, for all allocations; beyond it,
/// allocations fail. Files mapped by FileBytes count. A later call replaces the limit.
///
/// For programs, not libraries: the limit is that of the whole process (RLIMIT_DATA), and child processes inherit it.
void limit_memory(std::uint64_t bytes);

/// The memory of this machine in bytes, or the limit of the container's control group (version 2) if that is less.
std::uint64_t machine_memory();

}  // namespace zoneplate
