// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The pixel type of a channel. Number is a 32-bit unsigned integer.
enum class ExrType { Number = 0, Half = 1, Float = 2 };

/// One channel of an image: a view of one value per pixel, rows without padding.
struct ExrChannel {
  std::string name;  ///< "R", or with the name of its layer "N.X"; at most 31 bytes
  ExrType type = ExrType::Half;
  const float* value = nullptr;           ///< the first pixel's value, if type is Half or Float
  const std::uint32_t* number = nullptr;  ///< the first pixel's value, if type is Number
  std::size_t step = 1;                   ///< distance between the values of neighbouring pixels
};

/// The channels of a scene-linear image: R, G, B and A as half floats. They are views of the image.
std::vector<ExrChannel> rgba_channels(const LinearImage& image);

using ExrAttributes = std::vector<std::pair<std::string, std::string>>;

/// Encodes an OpenEXR image of one part: scanlines, ZIP compression in blocks of 16 rows, channels sorted by name, and
/// text attributes.
///
/// Units     Half values are rounded to nearest and clamped to the finite range.
/// Exact     the same bytes for any number of threads and any version of any library; no time stamp.
/// Requires  the names of the channels are distinct, and those of the attributes too.
/// Source    OpenEXR File Layout, openexr.com.
std::vector<std::uint8_t> encode_exr(int width, int height, std::vector<ExrChannel> channels,
                                     const ExrAttributes& attributes = {});

}  // namespace zoneplate
