// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/hex_color.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>

namespace zoneplate {

std::optional<Rgba8> parse_hex_color(std::string_view text) {
  if (!text.starts_with('#')) return std::nullopt;
  text.remove_prefix(1);
  const bool is_short = text.size() == 3 || text.size() == 4;
  if (!is_short && text.size() != 6 && text.size() != 8) return std::nullopt;
  const std::size_t digits = is_short ? 1 : 2;
  std::array<std::uint8_t, 4> code = {0, 0, 0, 255};
  for (std::size_t i = 0; i * digits < text.size(); ++i) {
    const char* const first = text.data() + i * digits;
    const auto [end, error] = std::from_chars(first, first + digits, code[i], 16);
    if (error != std::errc{} || end != first + digits) return std::nullopt;
    if (is_short) code[i] = static_cast<std::uint8_t>(code[i] * 17);
  }
  return Rgba8{code[0], code[1], code[2], code[3]};
}

std::string hex_color(Rgba8 c) { return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b); }

}  // namespace zoneplate
