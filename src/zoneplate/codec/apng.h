// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "zoneplate/codec/animation.h"

namespace zoneplate {

/// Encodes an animated PNG: a PNG file of the first frame, which programs without APNG support display, followed by the
/// other frames. Each frame is stored as the rectangle in which it differs from the one before.
///
/// Exact     lossless; no time stamp, the same animation gives the same bytes.
/// Source    PNG Specification, third edition (W3C 2023): chunks acTL, fcTL, fdAT.
std::unique_ptr<AnimationEncoder> make_apng_encoder(const AnimationFormat& format);

/// The APNG file of an animation.
std::vector<std::uint8_t> encode_apng(const Animation& animation);

}  // namespace zoneplate
