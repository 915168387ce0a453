// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/codec/animation.h"
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
  /// How long a frame of an animation is shown, after it has been decoded; null if images have no times.
  std::function<FrameTime(std::size_t)> time_of = {};
  int loops = 0;           ///< number of repetitions of an animation; 0: endless
  bool has_alpha = false;  ///< pixels of an animation may be transparent
  std::function<Picture(const ImageFile&)> decode = [](const ImageFile& file) { return decode_file(file); };

  Picture load(std::size_t index) const { return decode(open(index)); }
};

/// Lists the images of an operand.
///
/// A directory: its images and those of its subfolders, in natural order. A video (is_video_name): its frames, decoded
/// by ffmpeg, without times. Anything else: as list_pictures (metrics/file/picture_file.h).
/// Errors    ErrorKind::Input if nothing is found, or ffmpeg cannot decode the video.
/// `decoder` limits the frames of a video.
PictureSet open_pictures(const std::string& operand, const ProgramLimits& decoder = {});

/// True for a name that ends as a video: .mp4, .m4v, .mov, .mkv, .webm or .avi.
bool is_video_name(const std::string& path);

/// The times of the frames of a video, as ffprobe states them. If it states them for another number of packets, all
/// frames last equally long.
///
/// Errors    ErrorKind::Input if ffprobe, a program of ffmpeg, cannot read the video.
std::vector<FrameTime> video_times(const std::string& path, std::size_t frames, const ProgramLimits& decoder = {});

/// The frames of the set's only file, if that is an animated PNG, GIF or WebP of at least two frames; else the set.
/// They are composed as their format says, and best decoded in order: an earlier frame needs all before it again.
///
/// Errors    ErrorKind::Input naming the file and the cause, also for frames of more than `max_pixels`.
PictureSet with_frames(PictureSet set, std::uint64_t max_pixels);

/// Two images to compare, as indices into their sets; one of them may be missing.
struct PicturePair {
  std::string name;                            ///< of the test image, or of the reference without a test image
  std::optional<std::size_t> reference, test;  ///< at least one
};

/// Pairs the images of two sets. The images of two directories are paired by their path, or else by their path without
/// the extension; two sequences that are patterns by the numbers of their frames; all others by their order.
std::vector<PicturePair> pair_pictures(const PictureSet& reference, const PictureSet& test);

}  // namespace zoneplate::metrics
