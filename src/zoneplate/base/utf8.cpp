// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/utf8.h"

#include <cstddef>

namespace zoneplate {
namespace {

/// `code` is what take_code_point made of the bytes.
bool is_obeyed(char32_t code, std::string_view bytes) {
  const auto between = [](char32_t c, char32_t low, char32_t high) { return c >= low && c <= high; };
  if (code == replacement_character && bytes.size() == 1) code = static_cast<unsigned char>(bytes[0]);
  return code < 0x20 || between(code, 0x7f, 0x9f)                            // C0, DEL and C1
         || between(code, 0x2028, 0x202e) || between(code, 0x2066, 0x2069);  // line breaks and directions of Unicode
}

std::string shown(std::string_view text, std::string_view kept) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::string_view rest = text;
    const char32_t code = take_code_point(rest);
    const std::string_view bytes = text.substr(0, text.size() - rest.size());
    if (is_obeyed(code, bytes) && kept.find(bytes) == kept.npos)
      out += '?';
    else
      out += bytes;
    text = rest;
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return shown(text, ""); }
std::string printable_lines(std::string_view text) { return shown(text, "\n\t"); }

char32_t take_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t size = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
  constexpr unsigned masks[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  char32_t code = lead & masks[size];
  bool is_well = size > 0 && size <= text.size();
  for (std::size_t i = 1; is_well && i < size; ++i) {
    is_well = byte(i) >> 6 == 2;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  is_well = is_well && code >= least[size] && code < 0x110000 && code >> 11 != 0x1b;
  text.remove_prefix(is_well ? size : 1);
  return is_well ? code : replacement_character;
}

void append_utf8(std::string& out, char32_t code) {
  const auto byte = [&](char32_t b) { out += static_cast<char>(b); };
  const auto continuation = [&](int shift) { byte(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) return byte(0xc0 | code >> 6), continuation(0);
  if (code < 0x10000) return byte(0xe0 | code >> 12), continuation(6), continuation(0);
  byte(0xf0 | code >> 18), continuation(12), continuation(6), continuation(0);
}

}  // namespace zoneplate
