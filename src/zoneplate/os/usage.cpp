// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/usage.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>

namespace zoneplate {
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

MemoryFiles::MemoryFiles()
    : status_(::open("/proc/self/status", O_RDONLY | O_CLOEXEC)),
      clear_refs_(::open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC)) {}

MemoryFiles::~MemoryFiles() {
  for (const int file : {status_, clear_refs_})
    if (file >= 0) ::close(file);
}

bool MemoryFiles::reset_peak() const { return ::write(clear_refs_, "5", 1) == 1; }  // proc(5), clear_refs

std::optional<std::uint64_t> MemoryFiles::size(std::string_view name) const {
  char text[8192];
  const ssize_t read = ::pread(status_, text, sizeof text, 0);
  const std::string_view all(text, read > 0 ? static_cast<std::size_t>(read) : 0);
  std::size_t at = all.find(name);  // "VmHWM:     1234 kB"
  if (at == all.npos) return std::nullopt;
  at = std::min(all.size(), all.find_first_not_of(" \t", at + name.size()));
  std::uint64_t kilobytes = 0;
  if (std::from_chars(all.data() + at, all.data() + all.size(), kilobytes).ec != std::errc()) return std::nullopt;
  return kilobytes * 1024;
}

MemoryWatch::MemoryWatch(const MemoryFiles& files) : files_(files) {
  ::malloc_trim(0);
  if (files.reset_peak()) before_ = files.size("VmRSS:");
}

std::optional<std::uint64_t> MemoryWatch::rise() const {
  const std::optional<std::uint64_t> peak = before_ ? files_.size("VmHWM:") : std::nullopt;
  if (!peak) return std::nullopt;
  return *peak > *before_ ? *peak - *before_ : 0;
}

}  // namespace zoneplate
