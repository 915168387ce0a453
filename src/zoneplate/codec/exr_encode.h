// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
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

/// A fraction of integers.
struct ExrRational {
  std::int32_t numerator = 0;
  std::uint32_t denominator = 1;
};
/// A time code of SMPTE 12M in the packing of 60 fields per second: bits 0 to 3 and 4 to 5 are the units and tens of
/// the frame, 8 to 11 and 12 to 14 those of the second, 16 to 19 and 20 to 22 of the minute, 24 to 27 and 28 to 29 of
/// the hour. The flags between them are 0.
struct ExrTimeCode {
  std::uint32_t packed = 0;
};
/// The (x, y) of red, green, blue and white.
using ExrChromaticities = std::array<float, 8>;
/// The Rec.709 primaries, and D65: those of scene-linear images.
inline constexpr ExrChromaticities rec709_chromaticities = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
/// A 4 × 4 matrix that multiplies row vectors, row by row.
using ExrMatrix = std::array<float, 16>;
/// The value of an attribute of a header.
using ExrValue = std::variant<std::string, float, ExrRational, ExrTimeCode, ExrChromaticities, ExrMatrix>;
using ExrAttributes = std::vector<std::pair<std::string, ExrValue>>;

/// The compression of an OpenEXR image; the values are those of its header.
enum class ExrCompression : std::uint8_t {
  None = 0,  ///< the largest and fastest
  Zips = 2,  ///< deflated row by row: programs read single rows, as for playback
  Zip = 3,   ///< deflated in blocks of 16 rows: the smallest
};

/// Encodes an OpenEXR image of one part: scanlines, channels sorted by name, and attributes.
///
/// Units     Half values are rounded to nearest and clamped to the finite range.
/// Exact     the same bytes for any number of threads and any version of any library; no time stamp.
/// Requires  the names of the channels are distinct, and those of the attributes too.
/// Source    OpenEXR File Layout, openexr.com.
std::vector<std::uint8_t> encode_exr(int width, int height, std::vector<ExrChannel> channels,
                                     const ExrAttributes& attributes = {},
                                     ExrCompression compression = ExrCompression::Zip);

}  // namespace zoneplate
