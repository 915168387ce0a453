// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace zoneplate {

/// The bytes of a text of text_of_bytes: the decoder of web/report/bytes.js.
std::vector<std::uint8_t> bytes_of_text(const std::string& text);

/// What a page of html_page unpacks: the viewer's style and script, the colours of error maps, the data.
std::vector<std::string> parts_of_page(const std::string& page);

/// The data of a page of html_page, as JSON.
std::string content_of_page(const std::string& page);

}  // namespace zoneplate
