// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/animation.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate {

/// The format of a film whose frames last 1 / rate seconds.
///
/// Errors    ErrorKind::Usage for a rate that is not a fraction of small integers.
AnimationFormat film_format(double rate);

/// True for the name of a video that the program ffmpeg encodes: .mp4, .mov, .mkv, .webm or .gif.
bool is_encoded_by_ffmpeg(const std::string& output);

/// True for the name of a video, which is never a still image: .apng, or is_encoded_by_ffmpeg.
bool is_video(const std::string& output);

/// True if such a video has sides of even numbers of pixels: .mp4, .mov and .mkv.
bool has_even_sides(const std::string& output);

/// The frames per second that a .gif has at most: browsers show delays below 2 hundredths of a second as 10.
constexpr int max_gif_rate = 50;

/// The encoder of a film that is not encoded by ffmpeg: WebP by its name, lossless without a quality, else APNG.
std::unique_ptr<AnimationEncoder> make_film_encoder(const std::string& output, const AnimationFormat& format,
                                                    std::optional<int> webp_quality = std::nullopt);

/// Encodes the frames of an animated PNG by ffmpeg as a film (is_encoded_by_ffmpeg), with their times.
///
/// Edges     a GIF repeats endlessly; how long a video shows its last frame is ffmpeg's choice.
/// Errors    ErrorKind::Failed naming ffmpeg: it is not installed, exceeds a limit, or fails.
std::vector<std::uint8_t> encode_film(const std::string& output, std::span<const std::uint8_t> apng,
                                      const ProgramLimits& limits);

/// A film that ffmpeg encodes while further frames are drawn.
///
/// Edges     odd sides of an opaque video, whose codec requires even ones, repeat the last column and row; a .gif of
///           more than `max_gif_rate` frames per second lacks frames, evenly.
class FfmpegFilm {
 public:
  /// `check_time` is called while ffmpeg keeps this process waiting; ffmpeg is killed if it throws.
  /// Errors    ErrorKind::Failed if ffmpeg is not installed.
  FfmpegFilm(const std::string& output, int width, int height, const AnimationFormat& format,
             std::function<void()> check_time);

  /// Appends pixels in the order of the frames, RGBA, 8 bits per channel, rows from the top; in parts of any size.
  ///
  /// Errors    ErrorKind::Failed if ffmpeg takes none of them for an hour.
  void add(std::span<const std::uint8_t> pixels);

  /// The bytes of the animation. Called once, last.
  ///
  /// Errors    ErrorKind::Failed with the first line of ffmpeg's errors.
  std::vector<std::uint8_t> encode();

 private:
  void write_row();

  std::size_t row_bytes_, rows_;
  bool repeats_column_, repeats_row_;
  std::vector<std::uint8_t> row_;  ///< what has come of a row
  std::size_t rows_done_ = 0;      ///< of a frame
  RunningProgram ffmpeg_;
};

}  // namespace zoneplate
