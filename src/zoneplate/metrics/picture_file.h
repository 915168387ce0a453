// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// Loads an image from a PNG (8 or 16 bits), JPEG, WebP, HDR, EXR or PFM file, recognised by its first bytes. "-" is
/// stdin.
///
/// HDR, EXR and PFM contain unbounded linear light; their display-referred values are clamped.
/// Errors    ErrorKind::Input naming the file and the cause.
Picture load_picture(const std::string& path);

/// The same from the bytes of a file; `name` is for messages.
Picture decode_picture(std::span<const std::uint8_t> bytes, const std::string& name);

/// Lists the files of one operand, in order.
///
/// A directory: its .png, .jpg, .jpeg, .webp, .hdr, .exr and .pfm files in natural order (9 before 10), without
/// subfolders. A name whose last component contains `####` or `%04d`: the files with a number in its place, in the
/// order of the numbers. Any other operand: that file.
///
/// Errors    ErrorKind::Input if a directory or a pattern matches no image.
std::vector<std::string> list_pictures(const std::string& operand);

/// Lists the images of a directory and of its subfolders, in natural order of their paths.
///
/// Errors    ErrorKind::Input if there is none, or a folder cannot be read.
std::vector<std::string> list_pictures_below(const std::string& directory);

/// True if the names differ only by numbers, as those of the frames of a sequence do.
bool are_frames(const std::vector<std::string>& paths);

}  // namespace zoneplate::metrics
