// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate {

/// The number of processors that this process may use at once, at least 1: on Linux the size of the calling thread's
/// affinity mask, limited to the CPU quota of its control groups (cpu_quota), rounded up.
///
/// Exact     determined by the first call; later changes have no effect.
int usable_processors();

/// The CPU quota of the control groups of a process, in processors: the minimum over its group and the groups above it;
/// infinite without a quota.
///
/// `membership` is the text of /proc/self/cgroup, `mount` the folder where control groups are mounted (/sys/fs/cgroup).
/// Source    Documentation/admin-guide/cgroup-v2.rst (cpu.max) and scheduler/sched-bwc.rst (cpu.cfs_quota_us, version
///           1) of Linux.
double cpu_quota(const std::string& membership, const std::string& mount);

}  // namespace zoneplate
