#include "zoneplate/cli/film.h"

#include <fmt/format.h>

#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/image/apng.h"
#include "zoneplate/image/webp.h"
#include "zoneplate/report/child.h"

namespace zoneplate::cli {
namespace {

// One thread and no stamps: the same version of ffmpeg writes the same bytes. MP4 goes through a pipe in fragments.
const std::vector<std::string>& codec_of(const std::string& extension) {
  static const std::vector<std::string> mp4 = {
      "-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "16", "-pix_fmt", "yuv420p",
      "-movflags", "+frag_keyframe+empty_moov",     "-f",   "mp4"};
  static const std::vector<std::string> webm = {"-c:v", "libvpx-vp9", "-b:v",     "0",  "-crf",
                                                "20",   "-pix_fmt",   "yuva420p", "-f", "webm"};
  static const std::vector<std::string> gif = {
      "-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a", "-loop", "0", "-f", "gif"};
  return extension == ".mp4" ? mp4 : extension == ".webm" ? webm : gif;
}

}  // namespace

std::vector<std::uint8_t> encode_film(const Animation& film, const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".apng" || extension == ".png") return encode_apng(film);
  if (extension == ".webp") return encode_webp(film);

  const Rgba8Image& first = film.frames.front();
  std::vector<std::string> arguments = {"-v",
                                        "error",
                                        "-f",
                                        "rawvideo",
                                        "-pix_fmt",
                                        "rgba",
                                        "-s",
                                        fmt::format("{}x{}", first.width(), first.height()),
                                        "-r",
                                        fmt::format("{}/{}", film.per, film.seconds),
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
  for (const std::string& word : codec_of(extension)) arguments.push_back(word);
  arguments.push_back("-");
  std::string raw;
  for (const Rgba8Image& frame : film.frames)
    raw.append(reinterpret_cast<const char*>(frame.values().data()), frame.values().size() * sizeof(Rgba8));
  const int milliseconds = 60'000 + static_cast<int>(raw.size() / 1000);
  ChildAnswer answer = run_child("ffmpeg", arguments, raw, {.milliseconds = milliseconds});
  if (answer.code != 0 || answer.out.empty())
    throw Error(Trouble::Failed,
                fmt::format("ffmpeg: {}", answer.complaint.empty() ? "wrote nothing" : answer.complaint));
  return std::move(answer.out);
}

}  // namespace zoneplate::cli
