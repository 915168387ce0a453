#pragma once

#include <cstdint>
#include <optional>

namespace zoneplate::cli {

/// The greatest resident memory of the process so far, in bytes.
std::uint64_t peak_memory();

/// Processor time of all threads so far, in milliseconds.
double processor_ms();

/// Measures by how much the process' resident memory rises at most from now on.
///
/// What lies free in the heap is given back to the system first, so that work which follows other work counts in full.
class MemoryWatch {
 public:
  MemoryWatch();
  /// In bytes; nothing where the system does not tell.
  std::optional<std::uint64_t> rise() const;

 private:
  std::optional<std::uint64_t> before_;
};

}  // namespace zoneplate::cli
