// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// True for the first bytes of a GIF file.
bool is_gif(std::span<const std::uint8_t> bytes);

/// Width and height of the logical screen, or of the first frame if that has none; nothing if there is no frame.
std::optional<int2> find_gif_size(std::span<const std::uint8_t> bytes);

/// The number of images in a GIF file, up to the first block that is cut off.
std::size_t count_gif_frames(std::span<const std::uint8_t> bytes);

/// Opens a GIF file, of one or more frames.
///
/// Edges     the canvas is transparent at first, and where a frame is cleared, as in browsers, whatever the background
///           colour is. What a frame has outside of the logical screen is left out. A file may end without its trailer.
/// Units     times in hundredths of a second, as stored. A loop count of n is n + 1 repetitions; without one, 1.
/// Errors    as open_animation.
/// Source    GIF89a specification, CompuServe 1990.
std::unique_ptr<AnimationReader> open_gif(std::span<const std::uint8_t> bytes, const std::string& name,
                                          std::uint64_t max_pixels);

/// Decodes the first frame of a GIF file.
///
/// Errors    as open_animation.
Rgba8Image decode_gif(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
