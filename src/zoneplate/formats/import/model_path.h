// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/os/file.h"

namespace zoneplate {

/// Replaces every %XX by its byte; a % that is not followed by two hexadecimal digits is kept.
std::string decode_percent(std::string_view text);

/// Decodes a base64 text; white space is ignored, the padding may be missing. Nothing if the text is not base64.
std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text);

/// Whether the text begins with a scheme, as in http://host/file or data:,x.
bool has_scheme(std::string_view uri);

/// The file that a relative, percent-encoded URI names, resolved against `folder`. Nothing if it contains a zero byte,
/// or if it is outside that folder (absolute, through "..", or through a symbolic link) and neither one of `allowed`
/// nor below one of them.
std::optional<std::string> find_path(const std::string& folder, std::string_view uri,
                                     std::span<const std::string> allowed);

/// Finds the files that a model names, as find_path does, and where there is none of that name, one whose name differs
/// in the case of ASCII letters alone: many models were written where case does not count.
class PathFinder {
 public:
  PathFinder(std::string folder, std::span<const std::string> allowed)
      : folder_(std::move(folder)), allowed_(allowed) {}

  /// The path of a file that need not exist. In each folder of the path an entry of the very name comes first, then the
  /// first of another case in the order of bytes. A folder outside the model's and those that are allowed is not read.
  std::optional<std::string> find(std::string_view uri);

 private:
  using Names = std::map<std::string, std::string>;  ///< by the name in lower case
  const Names& names_in(const std::string& folder);

  std::string folder_;
  std::span<const std::string> allowed_;
  std::map<std::string, Names> known_;  ///< by folder
  std::size_t entries_ = 0;             ///< of all folders that were read
};

/// Opens a file that find_path found. It is checked again to be within the folder or `allowed`, because the path may
/// have changed in the meantime, and opened without following links, because it may change again. Without a limit it
/// may be larger than memory: FileBytes::reclaimable.
///
/// Errors    ErrorKind::Input naming the path: it now leads out of the folder, is not a regular file, cannot be read.
FileBytes open_found(const std::string& folder, const std::string& path, std::span<const std::string> allowed,
                     std::optional<std::uint64_t> limit);

/// Whether the path is a pipe, a socket or a device, which may have no end or block.
bool is_stream(const std::string& path);

}  // namespace zoneplate
