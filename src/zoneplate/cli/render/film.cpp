// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/webp.h"

namespace zoneplate::cli {
namespace {

using Words = std::vector<std::string>;

// The colours of video are BT.709, and tagged as such with the transfer curve of sRGB: untagged files are decoded by
// BT.601 or BT.709 depending on the player and on the size.
constexpr const char* to_bt709 = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int";
const Words bt709_tags = {"-colorspace", "bt709",        "-color_primaries", "bt709",
                          "-color_trc",  "iec61966-2-1", "-color_range",     "tv"};

struct Codec {
  std::string_view extension;
  Words words;
};

// Options of ffmpeg: one thread and no time stamps, so that the same version of ffmpeg writes the same bytes. MP4 and
// QuickTime are written to a pipe in fragments.
const std::vector<Codec>& codecs() {
  static const std::vector<Codec> all = [] {
    const Words h264 = {
        "-vf",    std::string(to_bt709) + ",pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "16", "-pix_fmt",
        "yuv420p"};
    const Words vp9 = {"-vf", to_bt709, "-c:v", "libvpx-vp9", "-b:v", "0", "-crf", "20", "-pix_fmt", "yuva420p"};
    const auto together = [](std::initializer_list<Words> parts) {
      Words out;
      for (const Words& part : parts) out.insert(out.end(), part.begin(), part.end());
      return out;
    };
    const Words fragments = {"-movflags", "+frag_keyframe+empty_moov+write_colr"};
    return std::vector<Codec>{
        {".mp4", together({h264, bt709_tags, fragments, {"-f", "mp4"}})},
        {".mov", together({h264, bt709_tags, fragments, {"-f", "mov"}})},
        {".mkv", together({h264, bt709_tags, {"-f", "matroska"}})},
        {".webm", together({vp9, bt709_tags, {"-f", "webm"}})},
        {".gif",
         {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a", "-loop", "0", "-f", "gif"}}};
  }();
  return all;
}

const Codec* find_codec(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  const auto found = std::ranges::find(codecs(), extension, &Codec::extension);
  return found == codecs().end() ? nullptr : &*found;
}

constexpr int longest_wait_ms = 3'600'000;  // GIF: all frames are encoded after the last one

Words arguments_for(const std::string& output, int width, int height, const AnimationFormat& format) {
  Words words = {"-v",
                 "error",
                 "-f",
                 "rawvideo",
                 "-pix_fmt",
                 "rgba",
                 "-s",
                 fmt::format("{}x{}", width, height),
                 "-r",
                 fmt::format("{}/{}", format.per, format.seconds),
                 "-i",
                 "-",
                 "-map_metadata",
                 "-1",
                 "-fflags",
                 "+bitexact",
                 "-flags:v",
                 "+bitexact",
                 "-threads",
                 "1"};
  for (const std::string& word : find_codec(output)->words) words.push_back(word);
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

std::unique_ptr<AnimationEncoder> make_film_encoder(const std::string& output, const AnimationFormat& format) {
  return std::filesystem::path(output).extension() == ".webp" ? make_webp_encoder(format) : make_apng_encoder(format);
}

FfmpegFilm::FfmpegFilm(const std::string& output, int width, int height, const AnimationFormat& format,
                       std::function<void()> check_time)
    : ffmpeg_("ffmpeg", arguments_for(output, width, height, format),
              {.milliseconds = longest_wait_ms, .check_time = std::move(check_time)}) {}

void FfmpegFilm::add(std::span<const std::uint8_t> pixels) { ffmpeg_.write(pixels); }

std::vector<std::uint8_t> FfmpegFilm::encode() {
  ProgramResult answer = ffmpeg_.finish();
  if (answer.code != 0 || answer.out.empty())
    throw Error(ErrorKind::Failed,
                fmt::format("ffmpeg: {}", answer.complaint.empty() ? "wrote nothing" : answer.complaint));
  return std::move(answer.out);
}

}  // namespace zoneplate::cli
