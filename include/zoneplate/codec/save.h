// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/image/color_profile.h"
#include "zoneplate/image/rgb.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The ending of a path in lower case, with its dot.
std::string extension_of(const std::string& path);

/// Requires that an image that is not opaque is written to a format with alpha, which those of the endings .jpg, .jpeg,
/// .pfm, .mp4, .mov and .mkv are not; `extension` is as extension_of returns it.
///
/// Errors    ErrorKind::Usage with `name` in front, the format and those with alpha.
void check_alpha(std::string_view extension, const std::string& name);

/// Saves a display-referred image in the format of the path's ending: .png, .jpg, .jpeg or .webp, or .avif or .jxl,
/// whose libraries are opened.
///
/// The file is written whole or not at all.
/// Errors    ErrorKind::Usage for another ending, and that of check_alpha for an image that is not opaque;
///           ErrorKind::Output naming the file; ErrorKind::Input if the library is not installed.
void save_image(const std::string& path, const Rgba8Image& image);

/// Saves a scene-linear, premultiplied image in the format of the path's ending: .exr (half floats, with alpha) or
/// .pfm.
///
/// Errors    as above.
void save_image(const std::string& path, const LinearImage& image);

/// The bytes of the file that save_image would write; with a profile, of values that it describes.
///
/// Requires  can_hold(extension_of(path), profile), or an empty profile.
///@{
std::vector<std::uint8_t> encode_image(const std::string& path, const Rgba8Image& image,
                                       const ColorProfile& profile = {});
std::vector<std::uint8_t> encode_image(const std::string& path, const LinearImage& image,
                                       const ColorProfile& profile = {});
///@}

/// The bytes of a display-referred image in the format of an ending, as extension_of returns it; `has_alpha` says
/// whether alpha is stored, and `name` is for errors, which are those of save_image.
std::vector<std::uint8_t> encode_codes(const Rgba8Image& image, bool has_alpha, std::string_view extension,
                                       const std::string& name, const ColorProfile& profile = {});

/// True if the format of an ending, as extension_of returns it, can state the profile: PNG all but OpenEXR's
/// chromaticities, JPEG and WebP an ICC profile, of RGB pixels in each case, and OpenEXR chromaticities.
bool can_hold(std::string_view extension, const ColorProfile& profile);

}  // namespace zoneplate
#pragma GCC visibility pop
