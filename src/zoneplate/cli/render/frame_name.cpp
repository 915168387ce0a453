// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/frame_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace zoneplate::cli {
namespace {

// The position of a name's placeholder for the number, and the minimum number of digits.
struct Place {
  std::size_t begin = 0, size = 0;
  int digits = 1;
};

std::optional<int> digits_of(const std::string& text) {
  if (text.size() > 2 || text.find_first_not_of("0123456789") != text.npos) return std::nullopt;
  return text.empty() ? 1 : std::stoi(text);
}

std::optional<Place> find_place(const std::string& name) {
  for (const char mark : {'#', '@'})
    if (const std::size_t first = name.find(mark); first != name.npos) {
      const std::size_t end = std::min(name.find_first_not_of(mark, first), name.size());
      return Place{first, end - first, static_cast<int>(end - first)};
    }
  if (const std::size_t dollar = name.find("$F"); dollar != name.npos) {
    const bool has_width = dollar + 2 < name.size() && name[dollar + 2] >= '1' && name[dollar + 2] <= '9';
    return Place{dollar, has_width ? 3u : 2u, has_width ? name[dollar + 2] - '0' : 1};
  }
  if (const std::size_t percent = name.find('%'); percent != name.npos) {
    const std::size_t end = name.find('d', percent);
    if (end != name.npos)
      if (const auto digits = digits_of(name.substr(percent + 1, end - percent - 1)))
        return Place{percent, end + 1 - percent, *digits};
  }
  if (const std::size_t brace = name.find("{frame"); brace != name.npos) {
    const std::size_t end = name.find('}', brace);
    if (end == name.npos) return std::nullopt;
    const std::string inside = name.substr(brace + 6, end - brace - 6);
    if (inside.empty()) return Place{brace, end + 1 - brace, 1};
    if (inside[0] == ':')
      if (const auto digits = digits_of(inside.substr(1))) return Place{brace, end + 1 - brace, *digits};
  }
  return std::nullopt;
}

}  // namespace

bool has_frame_number(const std::string& name) { return find_place(name).has_value(); }

std::string frame_name(const std::string& name, int frame) {
  std::string out = name;
  if (const auto place = find_place(out)) {
    const std::string sign = frame < 0 ? "-" : "";
    out.replace(place->begin, place->size, sign + fmt::format("{:0{}}", std::abs(frame), std::min(place->digits, 20)));
  }
  return out;
}

}  // namespace zoneplate::cli
