// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/frame_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace zoneplate {
namespace {

constexpr int max_digits = 20;

std::optional<int> digits_of(const std::string& text) {
  if (text.size() > 2 || text.find_first_not_of("0123456789") != text.npos) return std::nullopt;
  return text.empty() ? 1 : std::stoi(text);
}

// A placeholder that begins at `at`, whatever follows it.
std::optional<FramePlace> place_at(const std::string& name, std::size_t at) {
  const char mark = name[at];
  const std::string_view rest = std::string_view(name).substr(at);
  if (mark == '#' || mark == '@') {
    const std::size_t size = std::min(rest.find_first_not_of(mark), rest.size());
    return FramePlace{at, size, static_cast<int>(std::min<std::size_t>(size, max_digits))};
  }
  if (rest.starts_with("$F")) {
    const bool has_width = rest.size() > 2 && rest[2] >= '1' && rest[2] <= '9';
    return FramePlace{at, has_width ? 3u : 2u, has_width ? rest[2] - '0' : 1};
  }
  const bool is_printf = mark == '%', is_braced = rest.starts_with("{frame");
  if (!is_printf && !is_braced) return std::nullopt;
  const std::size_t end = rest.find(is_printf ? 'd' : '}');
  if (end == rest.npos) return std::nullopt;
  std::string inside(is_printf ? rest.substr(1, end - 1) : rest.substr(6, end - 6));
  if (is_braced && inside.starts_with(':'))
    inside.erase(0, 1);
  else if (is_braced && !inside.empty())
    return std::nullopt;
  const std::optional<int> digits = digits_of(inside);
  if (!digits) return std::nullopt;
  return FramePlace{at, end + 1, std::clamp(*digits, 1, max_digits)};
}

bool is_short(const std::string& name, const FramePlace& place) {
  return place.size == 1 || (place.size == 2 && name[place.begin] != '#' && name[place.begin] != '@');
}

}  // namespace

std::optional<FramePlace> find_frame_place(const std::string& name) {
  // A name may have marks of several kinds, of which the first in this order counts.
  for (const char mark : {'#', '@', '$', '%', '{'})
    for (std::size_t at = name.find(mark); at != name.npos; at = name.find(mark, at + 1)) {
      const std::optional<FramePlace> place = place_at(name, at);
      if (!place) continue;
      const std::size_t end = place->begin + place->size;
      const auto next = static_cast<unsigned char>(end < name.size() ? name[end] : '.');
      if (std::isdigit(next) == 0 && !(is_short(name, *place) && std::isalpha(next) != 0)) return place;
      at = end - 1;
    }
  return std::nullopt;
}

std::string frame_name(const std::string& name, const FramePlace& place, int frame) {
  const std::string sign = frame < 0 ? "-" : "";
  return std::string(name).replace(place.begin, place.size,
                                   sign + fmt::format("{:0{}}", std::abs(frame), place.digits));
}

std::optional<std::int64_t> frame_of(std::string_view text, int digits) {
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const auto size = static_cast<int>(text.size());
  if (size < digits || size > max_digits || (size > digits && text[0] == '0')) return std::nullopt;
  std::int64_t number = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    number = std::min(number * 10 + (c - '0'), std::int64_t{1} << 58);
  }
  if (is_negative && number == 0) return std::nullopt;
  return is_negative ? -number : number;
}

}  // namespace zoneplate
