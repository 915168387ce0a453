// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The colour of "#rgb", "#rgba", "#rrggbb" or "#rrggbbaa" in sRGB values, straight alpha; nothing for other texts.
std::optional<Rgba8> parse_hex_color(std::string_view text);

/// The colour without its alpha as "#rrggbb".
std::string hex_color(Rgba8 color);

}  // namespace zoneplate
