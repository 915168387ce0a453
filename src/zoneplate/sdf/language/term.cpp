// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/language/term.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "zoneplate/base/error.h"

namespace zoneplate::sdf {

void fail_at(std::string_view file, Position at, const std::string& cause) {
  throw Error(ErrorKind::Input, fmt::format("{}: line {}, column {}: {}", file, at.line, at.column, cause));
}

char Reader::take() {
  const char c = rest_.front();
  rest_.remove_prefix(1);
  if (c == '\n')
    at_ = {at_.line + 1, 1};
  else if ((static_cast<unsigned char>(c) & 0xc0) != 0x80)  // not a continuation byte of UTF-8
    ++at_.column;
  return c;
}

std::string_view Reader::take(std::size_t bytes) {
  const std::string_view taken = rest_.substr(0, bytes);
  for (std::size_t i = 0; i < taken.size(); ++i) take();
  return taken;
}

void Reader::skip_space() {
  while (!at_end() && (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r')) take();
}

double Reader::take_number() {
  const Position start = at_;
  std::string_view text = rest_;
  if (text.starts_with('+')) text.remove_prefix(1);
  const char first = text.empty() ? '\0' : text.front();
  const bool is_number =
      (first >= '0' && first <= '9') || first == '.' || (first == '-' && text.size() == rest_.size());
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) fail_at(file_, start, "the number is out of range");
  if (!is_number || error != std::errc{} || !std::isfinite(value)) fail("expected a number, found " + found());
  take(static_cast<std::size_t>(end - rest_.data()));
  return value;
}

std::string Reader::found() const {
  if (at_end()) return "the end of the file";
  const auto c = static_cast<unsigned char>(peek());
  return c < ' ' || c > '~' ? fmt::format("byte {:#04x}", c) : fmt::format("'{}'", peek());
}

}  // namespace zoneplate::sdf
