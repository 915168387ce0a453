// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "zoneplate/codec/system/stored_image.h"
#include "zoneplate/image/rgb_space.h"

namespace zoneplate {

/// What an image file says about the meaning of its values and about how it is shown.
struct FileColor {
  ColorProfile profile;
  std::string profile_flaw = {};  ///< why its ICC profile is not whole; empty if it is
  int orientation = 1;            ///< of Exif, 1 to 8; 1 is upright
  bool is_grey = false;           ///< its pixels are, by its header
  std::string scale = {};         ///< what else scales its values: exposure of HDR, scale of PFM
};

/// A PNG's cICP counts before its iCCP, sRGB, and gAMA with cHRM, as its specification has it; an sRGB chunk alone is
/// an empty profile.
/// Source    PNG Specification, third edition (W3C 2025), 4.3; ICC.1:2022 annex B (JPEG); Exif 2.32 (orientation).
FileColor read_file_color(std::span<const std::uint8_t> bytes);

/// The meaning of the values as text. Two files with equal values show the same colours only if these texts are equal;
/// those of all spellings of sRGB are.
///
/// Shape     one line; empty for what is assumed of files that say nothing: sRGB codes, or Rec.709 light.
std::string color_space_of(std::span<const std::uint8_t> bytes);

/// A file's colours, ready for use.
struct ImageColor {
  RgbSpacePtr space;  ///< null: sRGB codes, or Rec.709 light
  int orientation = 1;
  std::string flaw = {};  ///< why its profile is not used, one line with `name`; empty if it is
};

/// Reads them. A profile that means nothing is a flaw: the image is taken as sRGB.
///
/// Errors    those of open_icc_library (codec/color/icc.h), for a file with an ICC profile.
ImageColor read_image_color(std::span<const std::uint8_t> bytes, const std::string& name);

/// The same for an image that a SystemFormat has decoded: with its orientation, and without a space of light, which is
/// taken to have Rec.709 primaries; that is a flaw if the file states another space.
ImageColor color_of(const StoredImage& image, ImageColor stated, const std::string& name);

}  // namespace zoneplate
