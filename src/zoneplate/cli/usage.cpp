// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/usage.h"

#include <malloc.h>
#include <sys/resource.h>

#include <fstream>
#include <string>

namespace zoneplate::cli {
namespace {

/// A size from /proc/self/status, in bytes: "VmHWM:     1234 kB".
std::optional<std::uint64_t> status_size(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (std::uint64_t kilobytes = 0; word == name && status >> kilobytes) return kilobytes * 1024;
  return std::nullopt;
}

}  // namespace

std::uint64_t peak_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

double processor_ms() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](timeval t) { return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) * 1e-3; };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

MemoryWatch::MemoryWatch() {
  ::malloc_trim(0);
  // Writing "5" resets the peak to the current resident memory (proc(5), clear_refs).
  std::ofstream reset("/proc/self/clear_refs");
  if (reset << '5' << std::flush) before_ = status_size("VmRSS:");
}

std::optional<std::uint64_t> MemoryWatch::rise() const {
  const std::optional<std::uint64_t> peak = before_ ? status_size("VmHWM:") : std::nullopt;
  if (!peak) return std::nullopt;
  return *peak > *before_ ? *peak - *before_ : 0;
}

}  // namespace zoneplate::cli
