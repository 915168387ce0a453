#pragma once

#include <cstdint>

namespace zoneplate {

/// Takes from this process, for ever, every right that reading a model does not need.
///
/// From here on it may read files, allocate, start threads and write to what is open already. Whatever else it asks of
/// the system (a file to write, a network, another program, a debugger, code made at run time) ends it by SIGSYS.
///
/// Requires  one thread only.
/// Errors    false where the system has no such filter.
bool enter_sandbox();

/// Lets this process have so many bytes more of memory, so many seconds of processors' time, no larger files and no
/// core.
void limit_resources(std::uint64_t bytes, double seconds);

}  // namespace zoneplate
