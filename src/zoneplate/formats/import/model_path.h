// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/os/file.h"

namespace zoneplate {

/// The text with every %XX replaced by its byte; a % that is not followed by two hexadecimal digits stays.
std::string decode_percent(std::string_view text);

/// The bytes of a base64 text; white space is ignored, the padding may be missing. Nothing if it is not base64.
std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text);

/// Whether the text begins with a scheme, as in http://host/file or data:,x.
bool has_scheme(std::string_view uri);

/// The file that a relative, percent-encoded URI names, seen from `folder`; nothing if it leads out of that folder
/// (absolute, through "..", or through a symbolic link) and is not one of `allowed` or below one of them, or holds a
/// zero byte.
std::optional<std::string> find_path(const std::string& folder, std::string_view uri,
                                     std::span<const std::string> allowed);

/// Opens a file that find_path found. The file that is open is checked to lie in the folder or among `allowed`, not
/// only the one that stood under that name before.
///
/// Errors    ErrorKind::Input naming the path: it leads out of the folder by now, is no regular file, cannot be read.
FileBytes open_found(const std::string& folder, const std::string& path, std::span<const std::string> allowed,
                     std::uint64_t limit);

/// Whether there is something under this path that has no end or waits for another program: a pipe, a socket, a device.
bool is_stream(const std::string& path);

}  // namespace zoneplate
