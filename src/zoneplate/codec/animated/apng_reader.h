// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/codec/animated/animation_reader.h"

namespace zoneplate {

/// The number of frames in the acTL chunk of a PNG; 0 without one.
std::size_t count_apng_frames(std::span<const std::uint8_t> bytes);

/// Opens an animated PNG of 8 or 16 bits per channel.
///
/// Edges     an image before the first fcTL chunk is not a frame. A frame whose time has the denominator 0 has
///           hundredths of a second.
/// Exact     blending is in the codes of the file, rounded once.
/// Errors    as open_animation.
/// Source    PNG Specification, third edition (W3C 2023): chunks acTL, fcTL, fdAT.
std::unique_ptr<AnimationReader> open_apng(std::span<const std::uint8_t> bytes, const std::string& name,
                                           std::uint64_t max_pixels);

}  // namespace zoneplate
