// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// The name of an image format by a file's first bytes, with an article: "a PNG", "an AVIF", "an MP4 video"; "no known"
/// for others.
std::string_view format_of_image(std::span<const std::uint8_t> bytes);

/// The error of a file that is none of the formats that its reader has, which `expected` lists: "a.psd: is a PSD image,
/// expected PNG or JPEG".
Error unread_format(std::span<const std::uint8_t> bytes, const std::string& name, std::string_view expected);

}  // namespace zoneplate
