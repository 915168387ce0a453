// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/image/color_profile.h"
#include "zoneplate/image/rgb.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A decoded PNG: values as stored, expanded to four channels; 16-bit files keep their precision in `pixels16`.
struct PngImage {
  Rgba8Image pixels{};     ///< 8 bits a channel; of a 16-bit file its values rounded
  Rgba16Image pixels16{};  ///< empty unless the file has 16 bits a channel
};

/// True if the bytes begin with PNG's signature.
bool is_png(std::span<const std::uint8_t> bytes);

/// Decodes a PNG to 8 bits a channel, and one of 16 bits a channel to both depths.
/// Errors    ErrorKind::Input with `name` in front: not a PNG, truncated, corrupt, more than `max_pixels` pixels.
PngImage decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                    std::uint64_t max_pixels = std::uint64_t{1} << 28);
/// The same in the file's own depth alone: of `pixels` and `pixels16` one is empty.
PngImage decode_png_as_stored(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

/// True for a PNG whose header states 16 bits a channel.
bool has_16_bits(std::span<const std::uint8_t> png);

/// What `encode_png` writes.
struct PngOptions {
  bool has_alpha = true;        ///< false: RGB is written
  bool is_srgb = true;          ///< writes the sRGB chunk; false for data (depth, normals, ids)
  bool is_small = false;        ///< slower, smaller
  bool may_be_indexed = false;  ///< an opaque image of at most 256 colours is written with a palette
  std::vector<std::pair<std::string, std::string>> text = {};  ///< tEXt chunks (iTXt where not ASCII)
  ColorProfile profile = {};  ///< its chunks are written in place of sRGB, unless it is empty
};

///@{
/// No time stamp is written: equal images give equal bytes.
std::vector<std::uint8_t> encode_png(const Rgba8Image& image, const PngOptions& options = {});
std::vector<std::uint8_t> encode_png(const Rgba16Image& image, const PngOptions& options = {});
///@}
/// 16-bit grey.
std::vector<std::uint8_t> encode_png(const Plane<std::uint16_t>& image, const PngOptions& options = {});

}  // namespace zoneplate
#pragma GCC visibility pop
