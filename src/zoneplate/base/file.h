#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace zoneplate {

/// The bytes of a whole file, mapped read-only (or read, where it cannot be mapped, as a pipe or "-" for stdin).
///
/// Errors    Trouble::Input naming the file and the cause: missing, a directory, not readable, larger than `limit`. Of
/// one that is cut off while it is mapped: base/lost_bytes.h.
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

/// Writes a file whole or not at all: to a temporary name in the same directory, then renamed. "-" is stdout.
///
/// A temporary that is left by an exception is removed; `remove_temporaries` does so from a signal handler.
/// Errors    Trouble::Output naming the file and the cause; nothing is left behind under either name.
void save_bytes(const std::string& path, std::span<const std::uint8_t> bytes);

/// Removes the temporary files that are being written now; safe to call in a signal handler.
void remove_temporaries();

}  // namespace zoneplate
