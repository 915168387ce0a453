// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/codec/animation.h"

namespace zoneplate {

/// An animated WebP file.
///
/// Units     WebP counts milliseconds: frame i begins at round(1000 i seconds / per), so that the error does not add
/// up.
///
/// Exact     lossless, including the colours of transparent pixels; the same bytes with the same version of libwebp.
/// Errors    ErrorKind::Failed with libwebp's reason; sides above 16383 pixels are one.
std::vector<std::uint8_t> encode_webp(const Animation& animation);

}  // namespace zoneplate
