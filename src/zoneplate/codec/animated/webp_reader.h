// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// True for a WebP file that states to be animated.
bool is_animated_webp(std::span<const std::uint8_t> bytes);

/// The number of frames in a WebP file, up to the first that is cut off.
std::size_t count_webp_frames(std::span<const std::uint8_t> bytes);

/// Opens an animated WebP of one or more frames; libwebpdemux composes them.
///
/// Edges     the canvas is transparent at first, and where a frame is cleared, as in browsers.
/// Units     times in milliseconds, as stored.
/// Errors    as open_animation.
std::unique_ptr<AnimationReader> open_webp_animation(std::span<const std::uint8_t> bytes, const std::string& name,
                                                     std::uint64_t max_pixels);

/// Decodes the first frame of an animated WebP.
///
/// Errors    as open_animation.
Rgba8Image decode_first_webp_frame(std::span<const std::uint8_t> bytes, const std::string& name,
                                   std::uint64_t max_pixels);

}  // namespace zoneplate
