// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace zoneplate {

/// What an image file has besides its first image: "is an animation of 4 frames" (of GIF, WebP, APNG, AVIF; of
/// "several" in JPEG XL, which does not state how many) or "has 3 pages" (of TIFF; reduced copies do not count). Empty
/// if it has one image. Only headers are read.
std::string several_images(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
