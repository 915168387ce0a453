// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// The name of an image format by a file's first bytes, with an article: "a PNG", "an AVIF"; "no known" for others.
std::string_view format_of_image(std::span<const std::uint8_t> bytes);

/// The error of a file that is none of the formats that its reader has, which `expected` lists: "a.gif: is a GIF image,
/// expected PNG or JPEG".
Error unread_format(std::span<const std::uint8_t> bytes, const std::string& name, std::string_view expected);

/// The number of images that a file shows one after the other: those of an animated PNG; else 1.
std::uint32_t count_frames(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
