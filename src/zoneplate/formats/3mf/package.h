// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/zip/zip.h"

namespace zoneplate {

/// The name of a part in one form: percent-decoded, without a leading slash, without "." and "..", with slashes for
/// backslashes, ASCII in lower case. Open Packaging Conventions compare names so.
std::string part_name(std::string_view name);

/// A package of the Open Packaging Conventions: named parts in a ZIP archive.
///
/// Requires  the bytes and the budget outlive the package.
/// Errors    ErrorKind::Input, those of ZipArchive.
class Package {
 public:
  Package(std::span<const std::uint8_t> bytes, ImportBudget& budget);

  /// The number of the part of a name, of the first one if there are several.
  std::optional<std::size_t> find(std::string_view name) const;
  /// The name of a part as the archive states it.
  const std::string& name(std::size_t part) const { return archive_.names()[part]; }
  /// The name of the first part whose name ends so, in the form of part_name; empty if there is none.
  std::string find_ending(std::string_view ending) const;

  /// As ZipArchive::read.
  bool read(std::size_t part, const std::function<void(std::span<const std::uint8_t>)>& sink) {
    return archive_.read(part, sink);
  }
  /// The contents of a part, charged to the budget, which gets them back from the caller.
  std::vector<std::uint8_t> contents(std::size_t part);

  /// The target of the package's first relationship of a type, in the form of part_name; empty if there is none.
  std::string target_of_type(std::string_view type);

 private:
  ImportBudget& budget_;
  ZipArchive archive_;
  std::map<std::string, std::size_t, std::less<>> parts_;  ///< by part_name
};

}  // namespace zoneplate
