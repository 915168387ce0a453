// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "zoneplate/codec/exr/exr.h"
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

/// Of an EXR, those of its first part. A PNG's cICP counts before its iCCP, sRGB, and gAMA with cHRM, as its
/// specification has it; an sRGB chunk alone is an empty profile.
/// Source    PNG Specification, third edition (W3C 2025), 4.3; ICC.1:2022 annex B (JPEG); Exif 2.32 (orientation).
FileColor read_file_color(std::span<const std::uint8_t> bytes);

/// The meaning of the values as text. Two files with equal values show the same colours only if these texts are equal;
/// those of all spellings of sRGB are. Of an EXR, it is that of the part of a layer, which `exr` chooses.
///
/// Shape     one line; empty for what is assumed of files that say nothing: sRGB codes, or Rec.709 light.
/// Errors    those of choose_exr_layer (codec/exr/exr_layer.h), for an EXR.
std::string color_space_of(std::span<const std::uint8_t> bytes, const std::string& name = {},
                           const ExrChoice& exr = {});

/// A file's colours, ready for use.
struct ImageColor {
  RgbSpacePtr space;  ///< null: sRGB codes, or Rec.709 light
  int orientation = 1;
  std::string flaw = {};  ///< why its profile is not used, one line with `name`; empty if it is
};

/// Reads them. A profile that means nothing is a flaw: the image is taken as sRGB. Of an EXR, `exr` chooses the layer:
/// colours have the chromaticities of its part, and data, such as normals, has none.
///
/// Errors    those of open_icc_library (codec/color/icc.h), for a file with an ICC profile; those of choose_exr_layer
///           (codec/exr/exr_layer.h), for an EXR.
ImageColor read_image_color(std::span<const std::uint8_t> bytes, const std::string& name, const ExrChoice& exr = {});

/// The same for an image that a SystemFormat has decoded: with its orientation, the profile that the decoder found, and
/// without a space of light, which is taken to have Rec.709 primaries; that is a flaw if the file states another space.
ImageColor color_of(const StoredImage& image, ImageColor stated, const std::string& name);

}  // namespace zoneplate
