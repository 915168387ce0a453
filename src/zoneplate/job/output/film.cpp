// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/webp.h"
#include "zoneplate/os/run_on_file.h"

namespace zoneplate {
namespace {

using Words = std::vector<std::string>;

// The colours of video are BT.709, and tagged as such with the transfer curve of sRGB: untagged files are decoded by
// BT.601 or BT.709 depending on the player and on the size.
constexpr const char* to_palette = "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a";
constexpr const char* to_bt709 = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int";
const Words bt709_tags = {"-colorspace", "bt709",        "-color_primaries", "bt709",
                          "-color_trc",  "iec61966-2-1", "-color_range",     "tv"};

struct Codec {
  std::string_view extension;
  Words words;
  bool has_even_sides = false;  ///< H.264, whose chroma has half of the pixels along each axis
};

// Options of ffmpeg: one thread and no time stamps, so that the same version of ffmpeg writes the same bytes. MP4 and
// QuickTime are written to a pipe in fragments.
const std::vector<Codec>& codecs() {
  static const std::vector<Codec> all = [] {
    const Words h264 = {"-vf", to_bt709, "-c:v", "libx264", "-crf", "16", "-pix_fmt", "yuv420p"};
    const Words vp9 = {"-vf", to_bt709, "-c:v", "libvpx-vp9", "-b:v", "0", "-crf", "20", "-pix_fmt", "yuva420p"};
    const auto together = [](std::initializer_list<Words> parts) {
      Words out;
      for (const Words& part : parts) out.insert(out.end(), part.begin(), part.end());
      return out;
    };
    const Words fragments = {"-movflags", "+frag_keyframe+empty_moov+write_colr"};
    return std::vector<Codec>{
        {".mp4", together({h264, bt709_tags, fragments, {"-f", "mp4"}}), true},
        {".mov", together({h264, bt709_tags, fragments, {"-f", "mov"}}), true},
        {".mkv", together({h264, bt709_tags, {"-f", "matroska"}}), true},
        {".webm", together({vp9, bt709_tags, {"-f", "webm"}})},
        {".gif",
         {"-vf", fmt::format("fps=min(source_fps\\,{}),{}", max_gif_rate, to_palette), "-loop", "0", "-f", "gif"}}};
  }();
  return all;
}

const Codec* find_codec(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  const auto found = std::ranges::find(codecs(), extension, &Codec::extension);
  return found == codecs().end() ? nullptr : &*found;
}

int even(int side, bool is_needed) { return is_needed ? side + side % 2 : side; }

constexpr int longest_wait_ms = 3'600'000;  // GIF: all frames are encoded after the last one

const Words reproducible = {"-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-threads", "1"};

Words arguments_for(const std::string& output, int width, int height, const AnimationFormat& format) {
  Words words = {
      "-v",       "error",
      "-f",       "rawvideo",
      "-pix_fmt", "rgba",
      "-s",       fmt::format("{}x{}", even(width, has_even_sides(output)), even(height, has_even_sides(output))),
      "-r",       fmt::format("{}/{}", format.per, format.seconds),
      "-i",       "-"};
  for (const Words& part : {reproducible, find_codec(output)->words})
    words.insert(words.end(), part.begin(), part.end());
  words.push_back("-");
  return words;
}

}  // namespace

AnimationFormat film_format(double rate) {
  // The duration of a frame as a fraction of integers.
  AnimationFormat format;
  const bool is_whole = rate == std::floor(rate);
  format.seconds = is_whole ? 1 : 1000;
  format.per = static_cast<int>(std::lround(is_whole ? rate : rate * 1000));
  if (format.per < 1 || format.per > 65535)
    throw Error(ErrorKind::Usage, "--frame-rate: expected a whole number, or one up to 65");
  return format;
}

bool is_encoded_by_ffmpeg(const std::string& output) { return find_codec(output) != nullptr; }

bool is_video(const std::string& output) { return extension_of(output) == ".apng" || is_encoded_by_ffmpeg(output); }

bool has_even_sides(const std::string& output) {
  const Codec* const codec = find_codec(output);
  return codec != nullptr && codec->has_even_sides;
}

std::unique_ptr<AnimationEncoder> make_film_encoder(const std::string& output, const AnimationFormat& format,
                                                    std::optional<int> webp_quality) {
  if (std::filesystem::path(output).extension() == ".webp") return make_webp_encoder(format, webp_quality);
  return make_apng_encoder(format);
}

FfmpegFilm::FfmpegFilm(const std::string& output, int width, int height, const AnimationFormat& format,
                       std::function<void()> check_time)
    : row_bytes_(std::size_t{4} * static_cast<std::size_t>(width)),
      rows_(static_cast<std::size_t>(height)),
      repeats_column_(even(width, has_even_sides(output)) != width),
      repeats_row_(even(height, has_even_sides(output)) != height),
      ffmpeg_("ffmpeg", arguments_for(output, width, height, format),
              {.milliseconds = longest_wait_ms, .check_time = std::move(check_time)}) {}

void FfmpegFilm::add(std::span<const std::uint8_t> pixels) {
  if (!repeats_column_ && !repeats_row_) return ffmpeg_.write(pixels);
  while (!pixels.empty()) {
    const std::size_t n = std::min(row_bytes_ - row_.size(), pixels.size());
    row_.insert(row_.end(), pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(n));
    pixels = pixels.subspan(n);
    if (row_.size() == row_bytes_) write_row();
  }
}

void FfmpegFilm::write_row() {
  if (repeats_column_)
    for (std::size_t k = 0; k < 4; ++k) row_.push_back(row_[row_bytes_ - 4 + k]);
  ffmpeg_.write(row_);
  rows_done_ = (rows_done_ + 1) % rows_;
  if (rows_done_ == 0 && repeats_row_) ffmpeg_.write(row_);
  row_.clear();
}

namespace {

std::vector<std::uint8_t> film_of(ProgramResult answer) {
  if (answer.code != 0 || answer.out.empty())
    throw Error(ErrorKind::Failed,
                fmt::format("ffmpeg: {}", answer.complaint.empty() ? "wrote nothing" : answer.complaint));
  return std::move(answer.out);
}

/// The time of the last frame of an APNG in hundredths of a second, which ffmpeg would not read.
std::int64_t last_delay(std::span<const std::uint8_t> apng) {
  std::int64_t delay = 0;
  constexpr std::size_t time_at = 20;
  for_png_chunks(apng, [&](std::string_view name, std::span<const std::uint8_t> data) {
    if (name != "fcTL" || data.size() < time_at + 4) return true;
    const std::uint32_t time = get_png_word(data.subspan(time_at));
    const std::int64_t seconds = time >> 16, per = std::max(time & 0xffff, 1u);
    delay = (200 * seconds + per) / (2 * per);
    return true;
  });
  return delay;
}

}  // namespace

std::vector<std::uint8_t> FfmpegFilm::encode() { return film_of(ffmpeg_.finish()); }

std::vector<std::uint8_t> encode_film(const std::string& output, std::span<const std::uint8_t> apng,
                                      const ProgramLimits& limits) {
  // ffmpeg's reader of APNG seeks. The times of the frames are kept as they are, in microseconds.
  Words words = {"-v",          "error",          "-f",       "apng", "-i", "file:/dev/stdin", "-vsync",
                 "passthrough", "-enc_time_base", "1:1000000"};
  const Words gif = {"-vf", to_palette, "-loop", "0", "-final_delay", fmt::format("{}", last_delay(apng)), "-f", "gif"};
  for (const Words& part : {reproducible, extension_of(output) == ".gif" ? gif : find_codec(output)->words})
    words.insert(words.end(), part.begin(), part.end());
  words.push_back("-");
  return film_of(run_on_file("ffmpeg", words, apng, limits));
}

}  // namespace zoneplate
