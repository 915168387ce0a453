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
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A rectangle of pixels; both corners are inclusive.
struct ExrWindow {
  std::int32_t left = 0, top = 0, right = -1, bottom = -1;

  std::int64_t width() const { return std::int64_t{right} - left + 1; }
  std::int64_t height() const { return std::int64_t{bottom} - top + 1; }
  bool is_sound() const {
    constexpr std::int64_t max_side = 1 << 24;
    return width() > 0 && height() > 0 && width() <= max_side && height() <= max_side;
  }
  std::uint64_t pixels() const { return static_cast<std::uint64_t>(width()) * static_cast<std::uint64_t>(height()); }
};

/// The pixel type of a channel. Number is a 32-bit unsigned integer.
enum class ExrType { Number = 0, Half = 1, Float = 2 };

/// One channel of an image: a view of one value per pixel, rows without padding.
struct ExrChannel {
  std::string name;  ///< "R", or with the name of its layer "N.X"; at most 255 bytes
  ExrType type = ExrType::Half;
  const float* value = nullptr;           ///< the first pixel's value, of Half or Float
  const std::uint32_t* number = nullptr;  ///< the first pixel's value of Number, or in place of `value` its bits
  std::size_t step = 1;                   ///< distance between the values of neighbouring pixels
  int2 sampling{1, 1};                    ///< the columns and rows of the window to a sample; the others are not stored
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
/// A value of any type, as it is stored.
struct ExrStoredValue {
  std::string type;
  std::vector<std::uint8_t> bytes;
};
/// The value of an attribute of a header.
using ExrValue =
    std::variant<std::string, float, ExrRational, ExrTimeCode, ExrChromaticities, ExrMatrix, ExrStoredValue>;
using ExrAttributes = std::vector<std::pair<std::string, ExrValue>>;

/// The compression of an OpenEXR image; the values are those of its header.
enum class ExrCompression : std::uint8_t {
  None = 0,  ///< the largest and fastest
  Zips = 2,  ///< deflated row by row: programs read single rows, as for playback
  Zip = 3,   ///< deflated in blocks of 16 rows: the smallest
};

/// A part of an OpenEXR file: scanlines, and attributes, of which "pixelAspectRatio", "screenWindowCenter" and
/// "screenWindowWidth" have defaults.
struct ExrPartImage {
  ExrWindow data, display;
  std::vector<ExrChannel> channels;  ///< of the pixels of `data`
  ExrAttributes attributes = {};
  ExrCompression compression = ExrCompression::Zip;
};

/// Longer names need a bit of the version.
inline constexpr std::size_t max_short_exr_name = 31;

/// The header of a part, and what a file states about it.
struct ExrPartHeader {
  std::vector<std::uint8_t> bytes;  ///< its attributes, without the zero that ends them
  std::size_t chunks = 0;
  bool is_deep = false, has_long_names = false;
};

/// An encoded part.
struct ExrPartBytes {
  ExrPartHeader header;
  std::vector<std::vector<std::uint8_t>> chunks;  ///< without the number of the part
};

/// The header of the only part of a file or, with a name, of one of several. The values of the channels are not read.
ExrPartHeader exr_part_header(const ExrPartImage& part, const std::string& name = {});

/// Puts a file together from chunks that need not be in memory at the same time.
class ExrFileWriter {
 public:
  /// `bytes` is an estimate of what all chunks have: beyond it the file is copied while it grows.
  ExrFileWriter(std::vector<ExrPartHeader> parts, std::uint64_t bytes);
  /// Adds the next chunk of the first part that is not complete.
  ///
  /// Requires  a part is not complete.
  void add(std::span<const std::uint8_t> chunk);
  /// Requires  all parts are complete.
  std::vector<std::uint8_t> finish();

 private:
  std::vector<ExrPartHeader> parts_;
  std::vector<std::uint8_t> out_;
  std::size_t table_ = 0, part_ = 0, done_ = 0;  ///< the next entry of the offsets, and the next chunk
};

/// Encodes rows [first, end) of a part to chunks. The values of the channels are those of these rows alone, so that a
/// part can be encoded band by band.
///
/// Units     Half values are rounded to nearest and clamped to the finite range; those that are given as bits are kept.
/// Exact     the same bytes for any number of threads and any version of any library.
/// Requires  `first`, and an `end` before the last row, are multiples of 16; of the names and the window as below.
std::vector<std::vector<std::uint8_t>> encode_exr_rows(const ExrPartImage& part, std::int64_t first, std::int64_t end);

/// Encodes a part at once.
///
/// Units     Half values are rounded to nearest and clamped to the finite range; those that are given as bits are kept.
/// Exact     the same bytes for any number of threads and any version of any library; no time stamp.
/// Requires  the names of the channels are distinct, and those of the attributes too; the data window divides by the
///           sampling of each channel.
/// Source    OpenEXR File Layout, openexr.com.
ExrPartBytes encode_exr_part(const ExrPartImage& part, const std::string& name = {});

/// The file of these parts, whose chunks are released while it is put together.
std::vector<std::uint8_t> join_exr_parts(std::vector<ExrPartBytes> parts);

/// The file of one part whose windows are the whole image.
std::vector<std::uint8_t> encode_exr(int width, int height, std::vector<ExrChannel> channels,
                                     const ExrAttributes& attributes = {},
                                     ExrCompression compression = ExrCompression::Zip);

}  // namespace zoneplate
