// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace zoneplate {

/// The peak resident memory of the process, in bytes.
std::uint64_t peak_memory();

/// The CPU time of all threads, in milliseconds.
double processor_ms();

/// The files in /proc of this process by which MemoryWatch measures. A process that is confined afterwards opens them
/// before.
class MemoryFiles {
 public:
  MemoryFiles();
  ~MemoryFiles();
  MemoryFiles(const MemoryFiles&) = delete;
  MemoryFiles& operator=(const MemoryFiles&) = delete;

  /// Resets the peak to the current resident memory; false if the system does not provide it.
  bool reset_peak() const;
  /// A size of the file `status` in bytes: "VmHWM:", the peak, or "VmRSS:".
  std::optional<std::uint64_t> size(std::string_view name) const;

 private:
  int status_, clear_refs_;
};

/// Measures the peak increase of the process's resident memory since its construction.
///
/// The constructor returns free heap memory to the system, so that memory of earlier work is not reused.
class MemoryWatch {
 public:
  explicit MemoryWatch(const MemoryFiles& files);
  /// In bytes; nothing if the system does not provide it.
  std::optional<std::uint64_t> rise() const;

 private:
  const MemoryFiles& files_;
  std::optional<std::uint64_t> before_;
};

}  // namespace zoneplate
