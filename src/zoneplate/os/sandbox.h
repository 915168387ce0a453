// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace zoneplate {

/// The kernel's features to confine a process.
struct SandboxSupport {
  bool filters_calls = false;  ///< seccomp, Linux 3.5
  bool limits_files = false;   ///< Landlock, Linux 5.13
};
SandboxSupport sandbox_support();

/// Permanently removes every right of this process that reading and rendering a model does not need.
///
/// From here on it may read the files and folders of `readable` and what is below them (nothing: every file that its
/// user may read), allocate memory, start threads, and read and write what is open already. Any other system call (to
/// open a file for writing, to connect, to run another program, to trace another process, to make code at run time)
/// ends the process by SIGSYS; a file that is not readable is answered with EACCES.
///
/// Where the kernel has no Landlock, every file stays readable.
/// Requires  one thread only.
/// Errors    false where the kernel has no seccomp filters.
/// Source    seccomp(2) by libseccomp; landlock(7).
bool enter_sandbox(const std::optional<std::vector<std::string>>& readable);

/// Limits this process to `bytes` more of memory (os/memory_limit.h) and `seconds` of processor time, and lets it
/// neither make files larger nor leave a core dump. `seconds` may be infinite.
void limit_resources(std::uint64_t bytes, double seconds);

}  // namespace zoneplate
