#pragma once

#include <string>

namespace zoneplate {

/// The number of processors that this process may use at once, at least 1: on Linux those of the calling thread's
/// affinity mask, and no more than the CPU quota of its control groups (cpu_quota), rounded up.
///
/// Exact     found by the first call; later changes are not seen.
int usable_processors();

/// The CPU quota of the control groups of a process, in processors: the least of its group's and of the groups above
/// it; infinite where there is none.
///
/// `membership` is the text of /proc/self/cgroup, `mount` the folder where control groups are mounted (/sys/fs/cgroup).
/// Source    Documentation/admin-guide/cgroup-v2.rst (cpu.max) and scheduler/sched-bwc.rst (cpu.cfs_quota_us, version
///           1) of Linux.
double cpu_quota(const std::string& membership, const std::string& mount);

}  // namespace zoneplate
