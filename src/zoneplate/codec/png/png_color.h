// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/color_profile.h"

namespace zoneplate {

/// The chunks cICP, iCCP, gAMA and cHRM of a profile, which follow IHDR.
std::vector<std::uint8_t> png_color_chunks(const ColorProfile& profile);

}  // namespace zoneplate
