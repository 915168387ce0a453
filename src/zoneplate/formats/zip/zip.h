// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"

namespace zoneplate {

/// Whether bytes begin as a ZIP archive does.
bool is_zip(std::span<const std::uint8_t> bytes);

/// A ZIP archive in memory, read with the library minizip: stored and deflated files, ZIP64, data descriptors.
///
/// The files that are read may unpack to LoadLimits::memory bytes, all together.
/// Requires  the bytes and the budget outlive the archive.
/// Errors    ErrorKind::Input naming the budget's file: no archive, limits of the budget exceeded.
class ZipArchive {
 public:
  ZipArchive(std::span<const std::uint8_t> bytes, ImportBudget& budget);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  /// The names of the files as the archive states them, in its order.
  const std::vector<std::string>& names() const { return names_; }

  /// Calls `sink` for the contents of a file, piece by piece. Returns false if its checksum is wrong.
  ///
  /// Requires  `file` is an index into names(); `sink` does not use the archive.
  /// Errors    ErrorKind::Input naming the file: encrypted, another method of compression, damaged; those of `sink`.
  bool read(std::size_t file, const std::function<void(std::span<const std::uint8_t>)>& sink);

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<std::string> names_;
};

}  // namespace zoneplate
