// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

/// What an image file states about the colours of its values, in the form in which files state it.
///
/// Of several statements the first one counts, in the order of the members (PNG specification, third edition, 4.3).
struct ColorProfile {
  std::optional<std::array<std::uint8_t, 4>> cicp =
      {};                                   ///< code points of ITU-T H.273: primaries, curve, matrix, range
  std::vector<std::uint8_t> icc = {};       ///< an ICC profile, as it is in the file
  std::optional<std::uint32_t> gamma = {};  ///< PNG's gAMA, in units of 1/100000
  /// PNG's cHRM: x and y of white, red, green and blue, in units of 1/100000.
  std::optional<std::array<std::uint32_t, 8>> primaries = {};
  std::optional<std::array<float, 8>> chromaticities = {};  ///< OpenEXR's: x and y of red, green, blue and white

  /// True if nothing is stated: the values are sRGB codes, or light of Rec.709 primaries.
  bool empty() const { return *this == ColorProfile{}; }
  bool operator==(const ColorProfile&) const = default;
};

}  // namespace zoneplate
#pragma GCC visibility pop
