// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/animation.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate::cli {

/// An animation without frames, whose frames last 1 / rate seconds.
///
/// Errors    ErrorKind::Usage for a rate that is not a fraction of small integers.
Animation film_of(double rate);

/// True for the name of a video that the program ffmpeg encodes: .mp4, .mov, .mkv, .webm or .gif.
bool is_encoded_by_ffmpeg(const std::string& output);

/// The bytes of an APNG or WebP film.
std::vector<std::uint8_t> encode_film(const Animation& film, const std::string& output);

/// A film that ffmpeg encodes while further frames are drawn.
class FfmpegFilm {
 public:
  /// `timing` is the timing of the frames; its own frames are ignored.
  ///
  /// Errors    ErrorKind::Failed if ffmpeg is not installed.
  FfmpegFilm(const std::string& output, int width, int height, const Animation& timing);

  /// Appends pixels in the order of the frames, RGBA, 8 bits per channel, rows from the top; in parts of any size.
  ///
  /// Errors    ErrorKind::Failed if ffmpeg takes none of them for an hour.
  void add(std::span<const std::uint8_t> pixels);

  /// The bytes of the animation. Called once, last.
  ///
  /// Errors    ErrorKind::Failed with the first line of ffmpeg's errors.
  std::vector<std::uint8_t> encode();

 private:
  RunningProgram ffmpeg_;
};

}  // namespace zoneplate::cli
