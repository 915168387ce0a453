// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Lists the files of one operand, in order.
///
/// A directory: its .png, .jpg, .jpeg, .webp, .hdr, .exr and .pfm files in natural order (9 before 10), without
/// subfolders. A name whose last component contains `####` or `%04d`: the files with a number in its place, in the
/// order of the numbers. Any other operand: that file.
///
/// Errors    ErrorKind::Input if a directory or a pattern matches no image.
std::vector<std::string> list_pictures(const std::string& operand);

/// True if the names differ only by numbers, as those of the frames of a sequence do.
bool are_frames(const std::vector<std::string>& paths);

/// Two lists of images to compare; images with the same index are a pair.
struct PicturePairs {
  std::vector<std::string> reference, test;
};

/// Pairs the images of two operands. The images of two directories are paired by name, without the extension; all
/// others by their order.
///
/// Errors    ErrorKind::Input if an image has no partner, naming the first such image.
PicturePairs pair_pictures(const std::string& reference, const std::string& test);

}  // namespace zoneplate::metrics
