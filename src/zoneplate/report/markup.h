// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zoneplate {

/// Escapes text for the contents and the quoted attributes of XML and HTML. Control characters, which XML does not
/// allow, and bytes that are not UTF-8 become U+FFFD.
std::string escape_markup(std::string_view text);

}  // namespace zoneplate
