// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// An image from a PNG (8 or 16 bits), JPEG, WebP, HDR, EXR or PFM file, recognised by its first bytes. "-" is stdin.
///
/// HDR, EXR and PFM hold unbounded linear light; their display-referred values are clamped.
/// Errors    ErrorKind::Input naming the file and what is wrong with it.
Picture load_picture(const std::string& path);

/// The files of one operand, in order.
///
/// A directory: its .png, .jpg, .jpeg, .webp, .hdr, .exr and .pfm files by name, numbers in names as numbers (9 before
/// 10), nothing of its folders. A name with `####` or `%04d` in its last part: the files that have a number there, in
/// the numbers' order. Anything else: that file.
///
/// Errors    ErrorKind::Input where a directory or a pattern names no image.
std::vector<std::string> list_pictures(const std::string& operand);

/// True where the names differ by numbers alone: frames of one sequence, not a folder of several images.
bool are_frames(const std::vector<std::string>& paths);

/// Two lists of images to compare, first with first.
struct PicturePairs {
  std::vector<std::string> reference, test;
};

/// The images of two operands. Of two directories those of equal names (the extension apart) are pairs; of anything
/// else the first and first, second and second.
///
/// Errors    ErrorKind::Input where the lists differ, naming the first image that has no partner.
PicturePairs pair_pictures(const std::string& reference, const std::string& test);

}  // namespace zoneplate::metrics
