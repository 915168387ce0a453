// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// The contents of a whole file: mapped, or read if it cannot be mapped (a pipe, or "-" for stdin).
///
/// The mapping counts as memory of the process (os/memory_limit.h).
/// A FIFO, a device or a socket is refused at once, unless it is an open descriptor: "-", /dev/stdin or /dev/fd/N.
/// Errors    ErrorKind::Input naming the file and the cause: missing, not a file, not readable, larger than `limit`, a
///           pointer of Git LFS.
///           For a file that is truncated while it is mapped: os/mapped_file_guard.h.
class FileBytes {
 public:
  explicit FileBytes(const std::string& path, std::uint64_t limit = ~std::uint64_t{0});
  /// The contents of a file that may be larger than memory: its pages are not memory of the process, since the system
  /// may reclaim each of them at any time. Only regular files are accepted.
  static FileBytes reclaimable(const std::string& path);
  /// The same of an open file, which errors call `path`; the descriptor may then be closed.
  static FileBytes reclaimable(int descriptor, const std::string& path);
  /// The contents of an open file, which errors call `path`; the descriptor may then be closed.
  FileBytes(int descriptor, const std::string& path, std::uint64_t limit);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::span<const std::uint8_t> bytes() const { return bytes_; }

  /// Lets the system reclaim the memory of a part, which is loaded again at the next access; only for mapped files.
  void forget(const void* part, std::size_t size) const;
  /// Lets the system begin to load a part that is read soon; only for mapped files.
  void read_ahead(const void* part, std::size_t size) const;

 private:
  FileBytes() = default;
  void advise(const void* part, std::size_t size, int advice) const;

  std::span<const std::uint8_t> bytes_;
  bool mapped_ = false;
};

/// Reads a file, or stdin for "-", in parts of at most 1 MB, until its end or until `take` returns false. Unlike
/// FileBytes it keeps none of them.
///
/// Errors    ErrorKind::Input naming the file and the cause, as FileBytes; those of `take`.
void read_parts(const std::string& path, const std::function<bool(std::span<const std::uint8_t>)>& take);
/// Errors    ErrorKind::Input if `path` exists and FileBytes would refuse it because it is not a file: a directory, a FIFO,
///           a device or a socket. It does not wait for the other end of a FIFO.
void check_is_file(const std::string& path);

/// Writes a file in parts, completely or not at all: to a file without a name in the same directory, or with a hidden
/// one that is then renamed. "-" is stdout.
///
/// The contents of a target that cannot be renamed (stdout, a device, a pipe) are kept in memory until `commit` writes
/// them. A temporary file that is not committed is removed; `remove_temporaries` removes it from a signal handler.
/// Errors    ErrorKind::Output naming the file and the cause, from every member; no file remains under either name.
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
  std::unique_ptr<Temporary> file_;  ///< null if the target cannot be renamed
  std::vector<std::uint8_t> kept_;
};

/// Writes all bytes to a descriptor; if it is non-blocking, waits until its reader goes on. A closed pipe is an error
/// of the call and not a signal. Returns 0, or the `errno` of the failure.
int write_fully(int file, std::span<const std::uint8_t> bytes);

/// The file that a FileWriter for `path` makes or replaces: the end of a chain of symbolic links, which need not exist.
///
/// Errors    ErrorKind::Output for a loop of links.
std::string link_target(const std::string& path);

/// Writes `bytes` as a FileWriter does.
void save_bytes(const std::string& path, std::span<const std::uint8_t> bytes);

/// Checks, without writing, that a file can be saved under this name.
///
/// Errors    ErrorKind::Output naming the file and the cause: no folder, a folder or file without write permission, a
///           folder of that name, a name that is too long.
void check_savable(const std::string& path);

/// Removes the temporary files that are being written; async-signal-safe.
void remove_temporaries();

}  // namespace zoneplate
