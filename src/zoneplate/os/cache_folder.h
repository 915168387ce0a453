// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "zoneplate/os/file.h"

namespace zoneplate {

/// A folder of files that can be made again, in a place that other users may write to.
///
/// The folder is opened once, and its files by their names in it, so that nothing outside of it is read, written or
/// removed: the folder is a directory of the user and no symbolic link (folders above it may be links), and only
/// regular files of the user are read or removed. Nothing waits for a pipe or a device. A link, pipe or device that has
/// the name of a file is itself replaced when that file is stored.
/// Errors    none: what cannot be read is not there, and what cannot be written is left out.
class CacheFolder {
 public:
  /// The folder, if it is there.
  static std::optional<CacheFolder> open(const std::string& path);
  /// The folder, which is created with the folders above it if it is missing.
  static std::optional<CacheFolder> make(const std::string& path);

  CacheFolder(CacheFolder&& other) noexcept : folder_(std::exchange(other.folder_, -1)) {}
  CacheFolder& operator=(CacheFolder&&) = delete;
  ~CacheFolder();

  /// The contents of a file of at most `limit` bytes.
  std::optional<FileBytes> read(const std::string& name, std::uint64_t limit) const;
  /// Stores a file, whole or not at all; several processes may store the same one at once.
  void store(const std::string& name, std::span<const std::uint8_t> bytes) const;
  /// Removes files with this end of their names, those that were not read for the longest time first, until at most
  /// `most` bytes of them are left, and what interrupted processes left behind. Several processes may do so at once.
  void trim(std::string_view end, std::uint64_t most) const;

 private:
  explicit CacheFolder(int folder) : folder_(folder) {}

  int folder_;  ///< its descriptor
};

}  // namespace zoneplate
