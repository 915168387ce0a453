// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace zoneplate {

/// Whether the bytes of an image or video can be the whole file, which a copy that was interrupted is not. Contents are
/// not decoded:
///
///     .png .apng .jpg .jpeg .gif   the signature, and the mark of the end
///     .webp .mp4 .mov .pfm         the signature, and the size that the header gives
///     .exr                         the signature, and the end of the farthest chunk at the end of the file
///     others                       at least one byte
///
/// `extension` is that of the name, ".png".
bool is_whole_file(std::string_view extension, std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
