// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace zoneplate {

/// From this call on, bytes of a mapped file (FileBytes) that become unreadable, because the file is truncated or its
/// disk fails, read as 0; without it they end the process (SIGBUS).
///
/// For programs, not libraries: the signal handler is global. Faults in other memory are handled by the previous
/// action.
void survive_truncated_mappings();

/// Reports whether all bytes that were read since its construction existed.
class MappedFileWatch {
 public:
  MappedFileWatch();
  /// Errors    ErrorKind::Input naming `file`, if any mapped file has lost bytes since the construction.
  void check(const std::string& file) const;

 private:
  std::uint32_t before_;
};

/// Registers a mapping of FileBytes until leave_mapping. If the table is full, the mapping is not guarded.
void enter_mapping(const void* begin, std::size_t size);
void leave_mapping(const void* begin);

}  // namespace zoneplate
