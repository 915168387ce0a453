// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The images of one operand, in order. They are loaded one at a time.
struct PictureSet {
  std::vector<std::string> names;            ///< for messages: in a directory, the path within it
  std::function<Picture(std::size_t)> load;  ///< Errors: ErrorKind::Input naming the file and the cause
  bool is_directory = false;                 ///< its images are paired by name
  bool are_frames = false;                   ///< the images are consecutive frames of one sequence
};

/// Lists the images of an operand.
///
/// A directory: its images and those of its subfolders, in natural order. A video (.mp4, .m4v, .mov, .mkv, .webm, .avi,
/// .gif, .apng): its frames, decoded by ffmpeg. Anything else: as list_pictures (metrics/picture_file.h).
/// Errors    ErrorKind::Input if nothing is found, or ffmpeg cannot decode the video.
PictureSet open_pictures(const std::string& operand);

/// Two images to compare, as indices into their sets; one of them may be missing.
struct PicturePair {
  std::string name;                            ///< of the test image, or of the reference without a test image
  std::optional<std::size_t> reference, test;  ///< at least one
};

/// Pairs the images of two sets. The images of two directories are paired by their path, or else by their path without
/// the extension; all others by their order.
std::vector<PicturePair> pair_pictures(const PictureSet& reference, const PictureSet& test);

}  // namespace zoneplate::metrics
