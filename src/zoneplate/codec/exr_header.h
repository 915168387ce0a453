// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// A rectangle of pixels; both corners are inclusive.
struct ExrWindow {
  std::int32_t left = 0, top = 0, right = -1, bottom = -1;

  std::int64_t width() const { return std::int64_t{right} - left + 1; }
  std::int64_t height() const { return std::int64_t{bottom} - top + 1; }
  bool is_sound() const {
    constexpr std::int64_t most_side = 1 << 24;
    return width() > 0 && height() > 0 && width() <= most_side && height() <= most_side;
  }
  std::uint64_t pixels() const { return static_cast<std::uint64_t>(width()) * static_cast<std::uint64_t>(height()); }
};

/// A channel of a part.
struct ExrPartChannel {
  std::string name;
  bool is_number = false;  ///< of whole numbers, not of halves or floats
};

/// What the header of one part of an OpenEXR file states.
struct ExrPart {
  std::string name;                                    ///< files with one part need none
  ExrWindow data, display;                             ///< not sound if the header lacks them
  std::vector<ExrPartChannel> channels;                ///< in the order of the file
  std::optional<std::array<float, 8>> chromaticities;  ///< x and y of red, green, blue and white
  std::string color_space;  ///< the attributes that define its colours, as text; empty: Rec.709
};

/// The parts of an OpenEXR file in its order; only whole headers, thus none of other bytes.
std::vector<ExrPart> read_exr_parts(std::span<const std::uint8_t> bytes);

/// The first of them.
std::optional<ExrPart> read_exr_part(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
