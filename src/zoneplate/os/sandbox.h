// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace zoneplate {

/// The kernel's features for confining a process.
struct SandboxSupport {
  bool filters_calls = false;  ///< seccomp, Linux 3.5
  bool limits_files = false;   ///< Landlock, Linux 5.13
};
SandboxSupport sandbox_support();

/// Makes the filter for system calls that enter_sandbox installs, so that processes which this one forks need not make
/// it again. Optional.
void prepare_sandbox();

/// Permanently drops all rights of this process that reading and rendering a model does not need.
///
/// Afterwards the process can read the files of `readable` and below its folders (nothing: every file that its user may
/// read), allocate memory, start threads, and read and write open files. Any other system call (to open a file for
/// writing, to connect, to execute a program, to trace another process, to generate code at run time) ends the process
/// with SIGSYS; opening a file that is not in `readable` fails with EACCES.
///
/// Without Landlock in the kernel, every file stays readable.
/// Requires  only one thread.
/// Errors    false if the kernel has no seccomp filters.
/// Source    seccomp(2) by libseccomp; landlock(7).
bool enter_sandbox(const std::optional<std::vector<std::string>>& readable);

/// Limits this process to `bytes` more of memory (os/memory_limit.h) and `seconds` of processor time, and prevents it
/// from extending files and from dumping core. `seconds` may be infinite.
void limit_resources(std::uint64_t bytes, double seconds);

}  // namespace zoneplate
