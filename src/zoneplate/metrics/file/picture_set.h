// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/file/stored.h"
#include "zoneplate/metrics/picture.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate::metrics {

/// The images of one operand, in order. They are loaded one at a time.
struct PictureSet {
  std::vector<std::string> names;              ///< for messages: in a directory, the path within it
  std::function<ImageFile(std::size_t)> open;  ///< Errors: ErrorKind::Input naming the file and the cause
  std::vector<std::uint64_t> numbers = {};     ///< of the frames, ascending, if the operand is a pattern
  bool is_directory = false;                   ///< its images are paired by name
  bool are_frames = false;                     ///< their names differ only by numbers, or they are those of a video
  std::vector<std::string> others = {};        ///< images and films of a directory in formats that are not read there

  std::vector<std::string> files = {};  ///< the files that `open` opens
  std::function<Picture(const ImageFile&)> decode = [](const ImageFile& file) { return decode_file(file); };

  Picture load(std::size_t index) const { return decode(open(index)); }
};

inline const ProgramLimits video_limits{.milliseconds = 3'600'000, .bytes = std::size_t{1} << 34};

/// Lists the images of an operand.
///
/// A directory: its images and those of its subfolders, in natural order. A video (.mp4, .m4v, .mov, .mkv, .webm, .avi,
/// .gif, .apng): its frames, decoded by ffmpeg. Anything else: as list_pictures (metrics/file/picture_file.h).
/// Errors    ErrorKind::Input if nothing is found, or ffmpeg cannot decode the video.
/// `decoder` limits the frames of a video.
PictureSet open_pictures(const std::string& operand, const ProgramLimits& decoder = video_limits);

/// Two images to compare, as indices into their sets; one of them may be missing.
struct PicturePair {
  std::string name;                            ///< of the test image, or of the reference without a test image
  std::optional<std::size_t> reference, test;  ///< at least one
};

/// Pairs the images of two sets. The images of two directories are paired by their path, or else by their path without
/// the extension; two sequences that are patterns by the numbers of their frames; all others by their order.
std::vector<PicturePair> pair_pictures(const PictureSet& reference, const PictureSet& test);

}  // namespace zoneplate::metrics
