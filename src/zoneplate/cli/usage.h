// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace zoneplate::cli {

/// The greatest resident memory of the process so far, in bytes.
std::uint64_t peak_memory();

/// CPU time of all threads so far, in milliseconds.
double processor_ms();

/// Measures the peak increase of the process's resident memory from its construction on.
///
/// Free heap memory is returned to the system first, so that the memory of earlier work is not reused.
class MemoryWatch {
 public:
  MemoryWatch();
  /// In bytes; nothing if the system does not provide it.
  std::optional<std::uint64_t> rise() const;

 private:
  std::optional<std::uint64_t> before_;
};

}  // namespace zoneplate::cli
