// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace zoneplate {

/// From now on what a mapped file (FileBytes) loses while it is read, because it is cut off meanwhile or its disk
/// fails, reads as 0; without this call it ends the process (SIGBUS).
///
/// For programs: the signal is the whole process's. Of memory that is not a FileBytes's it does what it did before.
void survive_truncated_mappings();

/// Reports whether all bytes that were read since its construction existed.
class MappedFileWatch {
 public:
  MappedFileWatch();
  /// Errors    ErrorKind::Input naming `file`, if any mapped file lost bytes since this watch began.
  void check(const std::string& file) const;

 private:
  std::uint32_t before_;
};

/// Between these calls the mapping is a FileBytes's. One that finds no room among many is not watched.
void enter_mapping(const void* begin, std::size_t size);
void leave_mapping(const void* begin);

}  // namespace zoneplate
