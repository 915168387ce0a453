// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/scene/material.h"

namespace zoneplate {

/// Width and height as the header of an image states them that decode_image reads, or more of an AVIF; nothing for
/// other bytes.
std::optional<int2> find_image_size(std::span<const std::uint8_t> bytes);

/// The size of the decoded image in bytes, from its header; 0 if find_image_size returns nothing.
std::uint64_t decoded_image_memory(std::span<const std::uint8_t> bytes);

/// The maximum of the bytes that decoding allocates in addition to the image.
std::uint64_t image_working_memory(std::span<const std::uint8_t> bytes);

/// The decoded image of a texture.
struct DecodedImage {
  TexelImage texels;
  std::string flaw = {};  ///< damage of the file that the decoder passed over, after the name; empty if there is none

  /// The texels of a whole file.
  ///
  /// Errors    ErrorKind::Input with the flaw, if there is one.
  TexelImage whole() && {
    if (!flaw.empty()) throw Error(ErrorKind::Input, flaw);
    return std::move(texels);
  }
};

/// Decodes the image of a texture, PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, KTX2, BMP or TGA by its
/// first bytes, regardless of its name. The orientation of a TIFF, AVIF or JPEG XL does not turn it. Of an animation
/// the first frame is taken.
///
/// Texels keep the format of the file: 8 bits, 16 bits of a PNG, TIFF, AVIF or JPEG XL of more than 8, and linear
/// floats of HDR, EXR and of a TIFF or JPEG XL of floats. Colours of an EXR are divided by alpha where alpha is above
/// 0. An EXR may have a quarter of `max_pixels`, because decoding takes four times the memory per pixel.
///
/// Of a damaged JPEG what can be decoded is kept. `layer` is of an EXR (codec/exr/exr_layer.h).
///
/// Errors    ErrorKind::Input with `name` in front: another format (named, if known), corrupt, more than `max_pixels`.
DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                          const std::string& layer = {});

/// The same within the limits of an import.
///
/// Errors    those of the function above; ErrorKind::Input with the flaw, if the limits are strict.
inline DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                                 const LoadLimits& limits) {
  DecodedImage image = decode_image(bytes, name, limits.pixels);
  if (limits.is_strict) image = {.texels = std::move(image).whole()};
  return image;
}

/// A warning, without the name of the model, if an image has more than TextureImage::max_side texels along a side.
std::optional<std::string> size_warning(const TextureImage& image);

}  // namespace zoneplate
