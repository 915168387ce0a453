// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/memory_limit.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "zoneplate/base/size_text.h"

namespace zoneplate {
namespace {

/// The sixth of the seven numbers of /proc/self/statm, the pages of data and stack; 0 if it is not available.
std::uint64_t pages_of_data() {
  char text[256];  // seven numbers of at most 20 digits
  const int statm = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (statm < 0) return 0;
  const ssize_t size = ::read(statm, text, sizeof text);
  ::close(statm);
  const char *at = text, *const end = text + std::max<ssize_t>(size, 0);
  std::uint64_t pages = 0;
  for (int number = 1; number <= 6; ++number) {
    at = std::find_if(at, end, [](char c) { return c != ' '; });
    const auto [last, error] = std::from_chars(at, end, pages);
    if (error != std::errc()) return 0;
    at = last;
  }
  return pages;
}

}  // namespace

void limit_memory(std::uint64_t bytes) {
  const std::uint64_t pages = pages_of_data();
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const rlim_t requested = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + bytes;
  limit.rlim_cur = std::min(requested, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
}

std::string memory_limit_text(std::uint64_t bytes, const char* option) {
  std::uint64_t least = bytes;
  const char* name = option;
  const auto lower = [&](std::uint64_t limit, const char* of) {
    if (limit < least) least = limit, name = of;
  };
  rlimit space{}, data{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) lower(space.rlim_cur, "ulimit -v");
  if (::getrlimit(RLIMIT_DATA, &data) == 0 && data.rlim_max != RLIM_INFINITY) lower(data.rlim_max, "ulimit -d");
  return size_text(least) + " (" + name + ")";
}

std::uint64_t machine_memory() {
  std::uint64_t bytes =
      static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  // A container's own group is the mounted folder; the file is missing outside of containers, and contains "max"
  // without a limit.
  std::ifstream file("/sys/fs/cgroup/memory.max");
  if (std::uint64_t limit = 0; file >> limit) bytes = std::min(bytes, limit);
  return bytes;
}

}  // namespace zoneplate
