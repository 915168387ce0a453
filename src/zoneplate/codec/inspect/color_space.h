// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace zoneplate {

/// What an image file says about the meaning of its values: profile, gamma, primaries, exposure, orientation. Two files
/// with equal values show the same image only if these texts are equal.
///
/// A PNG's cICP counts before its iCCP, sRGB, and gAMA with cHRM, as its specification has it; all mean the same if
/// they say sRGB.
/// Shape     one line; empty for what is assumed of files that say nothing: sRGB codes, or Rec.709 light.
/// Source    PNG Specification, third edition (W3C 2025), 4.3; ICC.1:2022 annex B (JPEG); Exif 2.32 (orientation).
std::string color_space_of(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
