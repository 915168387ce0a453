// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/codec/animation.h"

namespace zoneplate {

/// Encodes an animated WebP file, one frame at a time: lossless, including the colours of transparent pixels, or of a
/// quality from 0 to 100 with chroma subsampling and lossless alpha.
///
/// Units     WebP stores whole milliseconds: frame i begins at round(1000 i seconds / per), and frames with times of their
///           own at the rounded sum of these, so that rounding errors do not accumulate.
///
/// Exact     the same bytes with the same version of libwebp.
/// Errors    ErrorKind::Failed with libwebp's reason, for example sides above 16383 pixels.
std::unique_ptr<AnimationEncoder> make_webp_encoder(const AnimationFormat& format,
                                                    std::optional<int> quality = std::nullopt);

/// The WebP file of an animation.
std::vector<std::uint8_t> encode_webp(const Animation& animation, std::optional<int> quality = std::nullopt);

}  // namespace zoneplate
