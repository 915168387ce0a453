// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/processors.h"

#ifdef __linux__
#include <sched.h>
#endif

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>
#include <thread>

namespace zoneplate {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

int processors_of_affinity() {
#ifdef __linux__
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return static_cast<int>(std::thread::hardware_concurrency());
}

/// The quota of version 2: "50000 100000" or "max 100000", microseconds of CPU time per period.
double quota_2(const std::string& folder) {
  std::ifstream file(folder + "/cpu.max");
  double quota = 0, period = 0;
  return file >> quota >> period && quota > 0 && period > 0 ? quota / period : unlimited;
}

/// The quota of version 1: the same numbers in two files, where -1 means no quota.
double quota_1(const std::string& folder) {
  std::ifstream quota_file(folder + "/cpu.cfs_quota_us"), period_file(folder + "/cpu.cfs_period_us");
  double quota = 0, period = 0;
  return quota_file >> quota && period_file >> period && quota > 0 && period > 0 ? quota / period : unlimited;
}

/// The least quota of a group and its ancestors, up to the mounted folder. In a container the group's own folder may be
/// missing, because the mounted folder is the container's.
double min_quota(const std::string& mount, std::string group, double (*quota_of)(const std::string&)) {
  double least = quota_of(mount);
  while (group.size() > 1) {
    least = std::min(least, quota_of(mount + group));
    group.resize(std::min(group.rfind('/'), group.size()));
  }
  return least;
}

bool names_cpu(std::string_view controllers) {
  std::istringstream names{std::string(controllers)};
  for (std::string name; std::getline(names, name, ',');)
    if (name == "cpu") return true;
  return false;
}

int find_processors() {
  std::ifstream file("/proc/self/cgroup");
  const std::string membership{std::istreambuf_iterator<char>(file), {}};
  const double quota = std::ceil(cpu_quota(membership, "/sys/fs/cgroup"));
  const int processors = std::max(1, processors_of_affinity());
  return quota < processors ? std::max(1, static_cast<int>(quota)) : processors;
}

}  // namespace

double cpu_quota(const std::string& membership, const std::string& mount) {
  double least = unlimited;
  std::istringstream lines(membership);
  for (std::string line; std::getline(lines, line);) {
    // The formats are "0::/group" in version 2 and "4:cpu,cpuacct:/group" in version 1.
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
    if (controllers.empty()) least = std::min(least, min_quota(mount, group, quota_2));
    if (names_cpu(controllers)) least = std::min(least, min_quota(mount + "/cpu", group, quota_1));
  }
  return least;
}

int usable_processors() {
  static const int processors = find_processors();
  return processors;
}

}  // namespace zoneplate
