// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace zoneplate {

/// What confining a process lacks here, in a container, or with the limits of this process: the causes, which are empty
/// for a complete sandbox.
struct SandboxLacks {
  std::string filter;  ///< for system calls: seccomp, Linux 3.5
  std::string files;   ///< the confinement to files: Landlock, Linux 5.13
};

/// Tries the sandbox, on a thread that ends afterwards, at the first call; it also makes the filter for system calls,
/// so that processes which this one forks need not make it again.
const SandboxLacks& sandbox_lacks();

/// Permanently drops all rights of this process that reading and rendering a model does not need.
///
/// Afterwards the process can read the files of `readable` and below its folders (nothing: every file that its user may
/// read), allocate memory, start threads, and read and write open files. Any other system call (to open a file for
/// writing, to connect, to execute a program, to trace another process, to generate code at run time) ends the process
/// with SIGSYS; opening a file that is not in `readable` fails with EACCES.
///
/// What sandbox_lacks() names is left out: without Landlock, every file stays readable.
/// Requires  only one thread.
/// Errors    ErrorKind::Failed with the cause if a part is refused that was accepted before.
/// Source    seccomp(2) by libseccomp; landlock(7).
void enter_sandbox(const std::optional<std::vector<std::string>>& readable);

/// Limits this process to `bytes` more of memory (os/memory_limit.h) and `seconds` of processor time, and prevents it
/// from extending files and from dumping core. `seconds` may be infinite.
void limit_resources(std::uint64_t bytes, double seconds);

}  // namespace zoneplate
