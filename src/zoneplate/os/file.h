// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// The bytes of a whole file, mapped (or read, where it cannot be mapped, as a pipe or "-" for stdin).
///
/// The mapping counts as memory of the process (os/memory_limit.h).
/// Errors    ErrorKind::Input naming the file and the cause: missing, a directory, not readable, larger than `limit`.
/// Of one that is cut off while it is mapped: os/mapped_file_guard.h.
class FileBytes {
 public:
  explicit FileBytes(const std::string& path, std::uint64_t limit = ~std::uint64_t{0});
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::span<const std::uint8_t> bytes() const { return bytes_; }

  /// Lets the system take back the memory of a part until it is looked at again, where the file can be read anew.
  void forget(const void* part, std::size_t size) const;

 private:
  std::span<const std::uint8_t> bytes_;
  bool mapped_ = false;
};

/// Writes a file in parts, whole or not at all: to a temporary name in the same directory, then renamed. "-" is stdout.
///
/// What cannot be renamed (stdout, a device, a pipe) is kept in memory until `commit` writes it. A temporary that is
/// not committed is removed; `remove_temporaries` does so from a signal handler.
/// Errors    ErrorKind::Output naming the file and the cause, from every member; nothing is left behind under either
/// name.
class FileWriter {
 public:
  explicit FileWriter(std::string path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void write(std::span<const std::uint8_t> bytes);
  void commit();

 private:
  class Temporary;
  std::string path_;
  std::unique_ptr<Temporary> file_;  ///< null for what cannot be renamed
  std::vector<std::uint8_t> kept_;
};

/// The same of bytes that are there already.
void save_bytes(const std::string& path, std::span<const std::uint8_t> bytes);

/// Checks, without writing, that a file can be saved under this name.
///
/// Errors    ErrorKind::Output naming the file and the cause: no folder, a folder or file without the right to write, a
///           folder of that name, a name that is too long.
void check_savable(const std::string& path);

/// Removes the temporary files that are being written now; safe to call in a signal handler.
void remove_temporaries();

}  // namespace zoneplate
