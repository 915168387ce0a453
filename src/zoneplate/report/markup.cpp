// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/markup.h"

#include "zoneplate/base/utf8.h"

namespace zoneplate {

std::string escape_markup(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const char32_t code = take_code_point(text);
    const bool is_control = code < 0x20 && code != '\n' && code != '\t';
    if (code == '&')
      out += "&amp;";
    else if (code == '<')
      out += "&lt;";
    else if (code == '>')
      out += "&gt;";
    else if (code == '"')
      out += "&quot;";
    else  // U+FFFE and U+FFFF are characters of neither HTML nor XML
      append_utf8(out, is_control || code == 0xfffe || code == 0xffff ? replacement_character : code);
  }
  return out;
}

}  // namespace zoneplate
