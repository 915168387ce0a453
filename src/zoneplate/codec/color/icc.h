// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "zoneplate/image/rgb_space.h"

namespace zoneplate {

/// The size that an ICC profile may have; those of printers have some hundred KiB.
inline constexpr std::size_t max_icc_bytes = std::size_t{4} << 20;

/// The colour space of pixels that an ICC profile states by its header: "RGB ", "GRAY", "CMYK"; empty if the bytes are
/// no header.
std::string icc_pixels(std::span<const std::uint8_t> profile);

/// Opens the library that read_icc_space uses, Little CMS. `name` is of the image, the prefix of messages.
///
/// Errors    ErrorKind::Input if it is not installed; LibraryNeeded (os/library.h).
void open_icc_library(const std::string& name);

/// Reads an ICC profile of RGB or grey pixels: curves and colorants as they are, tables as a grid for the perceptual
/// intent. `is_grey`: the pixels are, so that the profile may be of grey ones.
///
/// The library runs in a child process with limits; inside a LimitedChild, which has limits already, it runs in that
/// process.
/// Requires  open_icc_library.
/// Errors    ErrorKind::Input, with the cause alone: truncated, corrupt, of other pixels, of a class without pixels.
RgbSpace read_icc_space(std::span<const std::uint8_t> profile, bool is_grey);

}  // namespace zoneplate
