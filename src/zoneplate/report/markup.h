// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace zoneplate {

/// Escapes text for the contents and the quoted attributes of XML and HTML. Control characters, which XML does not
/// allow, and bytes that are not UTF-8 become U+FFFD.
std::string escape_markup(std::string_view text);

/// Bytes as a URI for `src`: "data:image/png;base64,...".
std::string data_uri(std::string_view media_type, std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
