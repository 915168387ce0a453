// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/values.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "zoneplate/formats/import/text_scan.h"
#include "zoneplate/image/hex_color.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<double> find_unit(std::string_view name) {
  constexpr std::pair<std::string_view, double> units[] = {{"millimeter", 1}, {"micron", 0.001}, {"centimeter", 10},
                                                           {"inch", 25.4},    {"foot", 304.8},   {"feet", 304.8},
                                                           {"meter", 1000}};
  for (const auto& [unit, millimetres] : units)
    if (name == unit) return millimetres;
  return std::nullopt;
}

float number_of(std::string_view text) {
  return find_number(trimmed(text)).value_or(std::numeric_limits<float>::quiet_NaN());
}

double double_of(std::string_view text) {
  return find_double(trimmed(text)).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::uint32_t index_of(std::string_view text) {
  constexpr std::uint32_t none = 0xffffffff;
  text = trimmed(text);
  std::uint32_t value = none;
  const char* const end = text.data() + text.size();
  const auto [stop, trouble] = std::from_chars(text.data(), end, value);
  return trouble == std::errc{} && stop == end ? value : none;
}

std::uint32_t index_of(const XmlElement& element, std::string_view attribute) {
  return index_of(element.find(attribute).value_or(""));
}

std::vector<std::string_view> words_of(std::string_view list) {
  std::vector<std::string_view> words;
  while (!(list = trimmed(list)).empty()) {
    std::size_t end = 0;
    while (end < list.size() && !is_space(list[end])) ++end;
    words.push_back(list.substr(0, end));
    list.remove_prefix(end);
  }
  return words;
}

std::optional<float4> find_hex_color(std::string_view text) {
  text = trimmed(text);
  const auto color = text.size() == 7 || text.size() == 9 ? parse_hex_color(text) : std::nullopt;
  if (!color) return std::nullopt;
  return float4{decode_srgb8(color->r), decode_srgb8(color->g), decode_srgb8(color->b),
                static_cast<float>(color->a) / 255};
}

std::optional<Affine> find_matrix(std::string_view text, double unit) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 12) return std::nullopt;
  Affine matrix;
  std::size_t word = 0;
  for (double3* const v : {&matrix.x, &matrix.y, &matrix.z, &matrix.move}) {
    const double scale = v == &matrix.move ? unit : 1;
    for (double* const value : {&v->x, &v->y, &v->z}) *value = double_of(words[word++]) * scale;
    if (!is_finite(narrowed(*v))) return std::nullopt;
  }
  return matrix;
}

}  // namespace zoneplate
