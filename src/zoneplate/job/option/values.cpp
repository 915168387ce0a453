// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/hex_color.h"

namespace zoneplate {
namespace {

template <class T>
std::optional<T> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at != std::string_view::npos;) {
    const std::size_t end = text.find(separator, at);
    parts.push_back(text.substr(at, end == std::string_view::npos ? end : end - at));
    at = end == std::string_view::npos ? end : end + 1;
  }
  return parts;
}

// The numbers of "a,b,c"; nothing if one of them is not a number.
template <class T>
std::optional<std::vector<T>> numbers_in(std::string_view text) {
  std::vector<T> numbers;
  for (const std::string_view part : split(text, ',')) {
    const std::optional<T> number = number_in<T>(part);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

[[noreturn]] void refuse_text(const std::string& text, const std::string& expected) {
  throw Error(ErrorKind::Usage, fmt::format("'{}' is not {}", text, expected));
}

// The sixteen basic names of CSS and the usual synonyms.
// Source: W3C, CSS Color Module Level 3, section 4.1.
struct NamedColor {
  std::string_view name, hex;
};
constexpr NamedColor named_colors[] = {{"black", "#000000"},   {"silver", "#c0c0c0"}, {"gray", "#808080"},
                                       {"grey", "#808080"},    {"white", "#ffffff"},  {"maroon", "#800000"},
                                       {"red", "#ff0000"},     {"purple", "#800080"}, {"fuchsia", "#ff00ff"},
                                       {"magenta", "#ff00ff"}, {"green", "#008000"},  {"lime", "#00ff00"},
                                       {"olive", "#808000"},   {"yellow", "#ffff00"}, {"orange", "#ffa500"},
                                       {"navy", "#000080"},    {"blue", "#0000ff"},   {"teal", "#008080"},
                                       {"aqua", "#00ffff"},    {"cyan", "#00ffff"},   {"transparent", "#00000000"}};

}  // namespace

double parse_number(const std::string& text, double low, double high) {
  const std::optional<double> value = number_in<double>(text);
  if (!value || *value < low || *value > high) refuse_text(text, fmt::format("a number from {} to {}", low, high));
  return *value;
}

int parse_whole(const std::string& text, int low, int high) {
  const std::optional<int> value = number_in<int>(text);
  if (!value || *value < low || *value > high)
    refuse_text(text, fmt::format("a whole number from {} to {}", low, high));
  return *value;
}

float radians_of(double degrees) { return static_cast<float>(degrees * 3.14159265358979323846 / 180); }

double3 parse_triple(const std::string& text) {
  const auto numbers = numbers_in<double>(text);
  if (!numbers || numbers->size() != 3) refuse_text(text, "three numbers x,y,z");
  const double3 triple{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  if (!is_finite(narrowed(triple))) refuse_text(text, "three numbers x,y,z");
  return triple;
}

int2 parse_size(const std::string& text, int max_side) {
  const auto sides = split(text, text.find('x') == std::string::npos ? ',' : 'x');
  const auto width = number_in<int>(sides.front()), height = number_in<int>(sides.back());
  if (sides.size() > 2 || !width || !height || *width < 1 || *height < 1)
    refuse_text(text, "a size WIDTH,HEIGHT, WIDTHxHEIGHT or SIDE");
  if (*width > max_side || *height > max_side)
    throw Error(ErrorKind::Usage, fmt::format("{} is too large: a side has at most {} pixels", text, max_side));
  return {*width, *height};
}

float4 parse_color(const std::string& text) {
  std::optional<Rgba8> color = parse_hex_color(text);
  for (const NamedColor& named : named_colors)
    if (text == named.name) color = parse_hex_color(named.hex);
  const auto unit = [](std::uint8_t code) { return static_cast<float>(code) / 255; };
  if (color) return {unit(color->r), unit(color->g), unit(color->b), unit(color->a)};

  const auto numbers = numbers_in<float>(text);
  const auto in_range = [](float x) { return x >= 0 && x <= 1; };
  if (!numbers || numbers->size() < 3 || numbers->size() > 4 ||
      !std::all_of(numbers->begin(), numbers->end(), in_range))
    refuse_text(text, "a colour: a name as red or white, #rgb, #rrggbb, #rrggbbaa, or r,g,b from 0 to 1");
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2], numbers->size() == 4 ? (*numbers)[3] : 1.0f};
}

std::uint64_t parse_bytes(const std::string& text) {
  constexpr std::string_view units = "KMG";
  std::string_view digits = text;
  const std::size_t unit = digits.empty() ? std::string_view::npos : units.find(digits.back());
  if (unit != std::string_view::npos) digits.remove_suffix(1);
  const int shift = unit == std::string_view::npos ? 0 : 10 * (static_cast<int>(unit) + 1);
  const auto value = number_in<std::uint64_t>(digits);
  if (!value || *value == 0 || *value > (~std::uint64_t{0} >> shift))
    refuse_text(text, "a size as 1000000, 512M or 4G");
  return *value << shift;
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.size(), text.find(',', start));
    items.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return items;
}

std::vector<std::string> split_specs(const std::string& text) {
  std::vector<std::string> items;
  for (const std::string& item : split_list(text)) {
    const bool is_parameter = item.find('=') != std::string::npos && item.find(':') == std::string::npos;
    if (is_parameter && !items.empty()) {
      items.back() += ',' + item;
    } else {
      items.push_back(item);
    }
  }
  return items;
}

std::size_t parse_choice(const std::string& text, std::span<const std::string_view> names) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string_view near = closest(text, names);
  throw Error(ErrorKind::Usage, near.empty() ? fmt::format("'{}' is not one of {}", text, fmt::join(names, ", "))
                                             : fmt::format("'{}' is not one of {}; did you mean {}?", text,
                                                           fmt::join(names, ", "), near));
}

Isa parse_isa(const std::string& text) {
  std::vector<std::string_view> names;
  for (const Isa each : all_isas) names.push_back(name_of(each));
  const Isa isa = all_isas[parse_choice(text, names)];
  const auto supported = supported_isas();
  if (std::find(supported.begin(), supported.end(), isa) == supported.end())
    throw Error(ErrorKind::Usage, fmt::format("this machine has no {}", text));
  return isa;
}

}  // namespace zoneplate
