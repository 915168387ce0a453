// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace zoneplate {

/// What a file states about the space of its colours.
struct ColorTags {
  std::span<const std::uint8_t> profile = {};            ///< ICC; empty: none
  std::optional<std::array<std::uint8_t, 2>> cicp = {};  ///< primaries and transfer function of ITU-T H.273
  bool is_grey = false;                                  ///< its pixels are
};

}  // namespace zoneplate
