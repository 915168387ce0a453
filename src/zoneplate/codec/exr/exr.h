// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of an OpenEXR image.
bool is_exr(std::span<const std::uint8_t> bytes);

/// Width and height of the display window of an OpenEXR image.
std::optional<int2> find_exr_size(std::span<const std::uint8_t> bytes);

/// The pixels of an OpenEXR image that are decoded.
enum class ExrArea {
  Display,  ///< the display window
  Whole,    ///< the smallest window that contains the display and the data window: with overscan
};

/// The image of an OpenEXR file that is decoded.
struct ExrChoice {
  std::string layer = {};  ///< choose_exr_layer (codec/exr/exr_layer.h)
  ExrArea area = ExrArea::Display;
};

/// Decodes a layer of an OpenEXR image (codec/exr/exr_layer.h), by default its colours: the channels R, G, B and A, or
/// Y as grey, or Y, RY and BY as luminance and chroma (codec/exr/exr_chroma.h); scanlines or the finest tiles, of any
/// compression. Channels beside these may have any sampling.
///
/// The library is loaded by the first call, and runs in a child process with limits; inside a LimitedChild, which has
/// limits already, it runs in that process.
/// Shape     the display window; black and transparent where the data window does not reach.
/// Units     as stored, premultiplied; NaN becomes 0, infinity 65504. Without A, alpha is 1.
/// Errors    ErrorKind::Input with `name` in front: not an OpenEXR image, deep, without these channels, with fewer
///           samples in one than pixels (chroma: than in every second column and row), truncated, corrupt, more than
///           `max_pixels` pixels. ErrorKind::Failed where libOpenEXRCore is not installed. Those of choose_exr_layer.
LinearImage decode_exr(std::span<const std::uint8_t> bytes, const std::string& name,
                       std::uint64_t max_pixels = std::uint64_t{1} << 28);

/// The same of any layer and area, with NaN and infinities as they are stored.
LinearImage decode_exr_as_stored(std::span<const std::uint8_t> bytes, const std::string& name,
                                 std::uint64_t max_pixels = std::uint64_t{1} << 28, const ExrChoice& choice = {});

/// Decodes an image as decode_exr does, and passes it on row by row, from the top.
void decode_exr_rows(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                     const std::function<void(std::span<const Linear>)>& take_row, const std::string& layer = {});

/// The names of the channels of the first part, in the order of the file; none if the header is wrong.
std::vector<std::string> exr_channel_names(std::span<const std::uint8_t> bytes);

/// Decodes channels of the first part, of any names and types, as floats, in the order of `channels`.
///
/// Shape     the display window; 0 where the data window does not reach.
/// Units     as stored, with NaN and infinities; integers above 2²⁴ are rounded.
/// Errors    those of decode_exr; ErrorKind::Input if the file lacks a channel.
std::vector<Plane<float>> decode_exr_channels(std::span<const std::uint8_t> bytes, const std::string& name,
                                              std::span<const std::string> channels,
                                              std::uint64_t max_pixels = std::uint64_t{1} << 28);

/// The same channels of any part (codec/exr/exr_header.h) and any window, by default the display window, as bits: of
/// floats, to which halves are converted, or of whole numbers. Of channels with fewer samples than pixels, the pixels
/// between these are 0.
std::vector<Plane<std::uint32_t>> decode_exr_bits(std::span<const std::uint8_t> bytes, const std::string& name,
                                                  int part, std::span<const std::string> channels,
                                                  const std::optional<ExrWindow>& window = std::nullopt);

/// The same with halves as their 16 bits.
std::vector<Plane<std::uint32_t>> decode_exr_stored(std::span<const std::uint8_t> bytes, const std::string& name,
                                                    int part, std::span<const std::string> channels,
                                                    const ExrWindow& window);

/// The number of rows to decode together, so that planes of `channels` channels take at most 64 MB, but at least the
/// rows of a chunk. A part in such bands takes little longer than at once.
///
/// Shape     a multiple of 16, as chunks of ZIP are written, and of the rows of a chunk if these are one.
/// Requires  the data window is sound.
std::int64_t exr_band_rows(const ExrPart& part, std::size_t channels);

/// The memory in bytes that decoding takes in addition to the rows.
std::uint64_t exr_working_memory(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
