// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zoneplate {

/// The replacement character, U+FFFD.
constexpr char32_t replacement_character = 0xfffd;

/// Takes the first code point from the front of UTF-8 text; U+FFFD for a byte that is not UTF-8, where overlong forms,
/// surrogates and codes above U+10FFFF are not. Requires: the text is not empty.
char32_t take_code_point(std::string_view& text);

/// The text with '?' for every character that a terminal may obey instead of showing it: control characters, line
/// breaks included, marks that reverse the direction of text, and bytes that are no UTF-8 but control characters
/// elsewhere.
///
/// Names out of files, and names of files, are printed in this form.
std::string printable(std::string_view text);
/// The same for text of several lines: line breaks and tabs are kept.
std::string printable_lines(std::string_view text);

/// Appends a code point as UTF-8. Requires: it is not a surrogate and at most U+10FFFF.
void append_utf8(std::string& out, char32_t code);

}  // namespace zoneplate
