// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace zoneplate::cli {

/// The peak resident memory of the process, in bytes.
std::uint64_t peak_memory();

/// The CPU time of all threads, in milliseconds.
double processor_ms();

/// Measures the peak increase of the process's resident memory since its construction.
///
/// The constructor returns free heap memory to the system, so that memory of earlier work is not reused.
class MemoryWatch {
 public:
  MemoryWatch();
  /// In bytes; nothing if the system does not provide it.
  std::optional<std::uint64_t> rise() const;

 private:
  std::optional<std::uint64_t> before_;
};

}  // namespace zoneplate::cli
