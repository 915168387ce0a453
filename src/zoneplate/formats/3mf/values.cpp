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

std::optional<float> find_unit(std::string_view name) {
  constexpr std::pair<std::string_view, float> units[] = {
      {"millimeter", 1.0f}, {"micron", 0.001f}, {"centimeter", 10.0f}, {"inch", 25.4f},
      {"foot", 304.8f},     {"feet", 304.8f},   {"meter", 1000.0f}};
  for (const auto& [unit, millimetres] : units)
    if (name == unit) return millimetres;
  return std::nullopt;
}

float number_of(std::string_view text) {
  return find_number(trimmed(text)).value_or(std::numeric_limits<float>::quiet_NaN());
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

std::optional<float4x4> find_matrix(std::string_view text, float unit) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 12) return std::nullopt;
  float4x4 matrix;
  for (std::size_t row = 0; row < 4; ++row) {
    const float scale = row == 3 ? unit : 1.0f;
    const float3 v{number_of(words[3 * row]), number_of(words[3 * row + 1]), number_of(words[3 * row + 2])};
    if (!is_finite(v * scale)) return std::nullopt;
    matrix.column[row] = {v.x * scale, v.y * scale, v.z * scale, row == 3 ? 1.0f : 0.0f};
  }
  return matrix;
}

}  // namespace zoneplate
