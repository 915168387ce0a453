// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/picture_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"
#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate::metrics {
namespace {

namespace fs = std::filesystem;

/// Splits a stream of PNG files at their ends.
std::vector<std::span<const std::uint8_t>> split_png_stream(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t signature = 8, chunk_frame = 12;
  std::vector<std::span<const std::uint8_t>> images;
  while (bytes.size() > signature) {
    std::size_t at = signature;
    bool is_whole = false;
    while (!is_whole && bytes.size() - at >= chunk_frame) {
      const std::uint8_t* chunk = bytes.data() + at;
      const std::size_t length = std::size_t{chunk[0]} << 24 | std::size_t{chunk[1]} << 16 |
                                 std::size_t{chunk[2]} << 8 | std::size_t{chunk[3]};
      if (bytes.size() - at - chunk_frame < length) break;
      is_whole = std::string_view(reinterpret_cast<const char*>(chunk) + 4, 4) == "IEND";
      at += chunk_frame + length;
    }
    if (!is_whole) break;
    images.push_back(bytes.first(at));
    bytes = bytes.subspan(at);
  }
  return images;
}

/// What a program of ffmpeg prints about a video.
std::vector<std::uint8_t> output_of(const std::string& program, const std::string& path,
                                    std::vector<std::string> arguments, const ProgramLimits& limits) {
  arguments.insert(arguments.begin(), {"-v", "error"});
  try {
    ProgramResult result = run_child(program, arguments, "", limits);
    if (result.code == 0) return std::move(result.out);
    throw Error(ErrorKind::Input,
                result.complaint.empty() ? program + " cannot read it" : program + ": " + result.complaint);
  } catch (const Error& reason) {
    throw Error(ErrorKind::Input, fmt::format("{}: {}", path, reason.what()));
  }
}

/// Microseconds of a line of ffprobe that begins with a decimal number of seconds.
std::optional<std::int64_t> microseconds_in(std::string_view line) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), seconds);
  if (error != std::errc() || !(std::abs(seconds) < 1e9)) return std::nullopt;
  return std::llround(seconds * 1e6);
}

/// The frames of an animation, of which the last decoded one is kept.
class FrameCursor {
 public:
  FrameCursor(ImageFile file, std::uint64_t max_pixels)
      : file_(std::move(file)), max_pixels_(max_pixels), reader_(opened()) {}

  const AnimationReader* reader() const { return reader_.get(); }
  const ImageFile& file() const { return file_; }

  /// What the animation states about the colours of all frames.
  const ImageColor& color() {
    if (!color_) color_ = read_image_color(file_.bytes, file_.name);
    return *color_;
  }

  const AnimationFrame& at(std::size_t i) {
    if (i + 1 < done_) reader_ = opened(), done_ = 0;
    for (; done_ < i + 1; ++done_) frame_ = reader_->next();
    return frame_;
  }

 private:
  std::unique_ptr<AnimationReader> opened() const { return open_animation(file_.bytes, file_.name, max_pixels_); }

  const ImageFile file_;
  const std::uint64_t max_pixels_;
  std::unique_ptr<AnimationReader> reader_;
  std::optional<ImageColor> color_;
  std::size_t done_ = 0;
  AnimationFrame frame_;
};

/// The frames of a video, which are kept as PNG files in memory.
PictureSet open_video(const std::string& path, const ProgramLimits& limits) {
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(ErrorKind::Input, path + ": no such file");
  check_is_file(path);
  // Viewers display the codes of BT.709 as those of sRGB; ffmpeg would state a gamma of 1.96 for them.
  const std::string srgb_curve = "setparams=color_trc=iec61966-2-1";
  const auto stream =
      std::make_shared<std::vector<std::uint8_t>>(output_of("ffmpeg", path,
                                                            {"-nostdin",
                                                             "-i",
                                                             "file:" + path,
                                                             "-map",
                                                             "0:v:0",
                                                             "-vsync",
                                                             "passthrough",
                                                             "-vf",
                                                             srgb_curve,
                                                             "-sws_flags",
                                                             "accurate_rnd+full_chroma_int+full_chroma_inp",
                                                             "-c:v",
                                                             "png",
                                                             "-pred",
                                                             "mixed",
                                                             "-compression_level",
                                                             "1",
                                                             "-f",
                                                             "image2pipe",
                                                             "-"},
                                                            limits));
  const auto images = split_png_stream(*stream);
  if (images.empty()) throw Error(ErrorKind::Input, path + ": the video has no frame");
  constexpr std::size_t color_type = 25;  // of the first chunk of a PNG
  constexpr std::uint8_t alpha = 4;
  PictureSet set{.are_frames = true,
                 .has_alpha = images[0].size() > color_type && (images[0][color_type] & alpha) != 0};
  for (std::size_t i = 0; i < images.size(); ++i) set.names.push_back(fmt::format("frame {}", i + 1));
  set.open = [stream, images, path](std::size_t i) {
    return ImageFile{.name = fmt::format("{}, frame {}", path, i + 1), .bytes = images[i], .owner = stream};
  };
  return set;
}

std::string without_extension(const std::string& path) { return fs::path(path).replace_extension().string(); }

}  // namespace

bool is_video_name(const std::string& path) {
  constexpr std::array<std::string_view, 6> known = {".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi"};
  return std::ranges::find(known, lower_case(fs::path(path).extension().string())) != known.end();
}

std::vector<FrameTime> video_times(const std::string& path, std::size_t frames, const ProgramLimits& limits) {
  const std::vector<std::uint8_t> out = output_of(
      "ffprobe", path, {"-select_streams", "v:0", "-show_entries", "packet=pts_time", "-of", "csv=p=0", "file:" + path},
      limits);
  std::vector<std::int64_t> begins;
  const std::string_view text(reinterpret_cast<const char*>(out.data()), out.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.size(), text.find('\n', at));
    if (const std::optional<std::int64_t> begin = microseconds_in(text.substr(at, end - at))) begins.push_back(*begin);
    at = end + 1;
  }
  std::ranges::sort(begins);
  constexpr std::int64_t unknown = 40'000;  // 25 frames per second
  const std::int64_t mean =
      begins.size() < 2 ? unknown : (begins.back() - begins.front()) / static_cast<std::int64_t>(begins.size() - 1);
  std::vector<FrameTime> times(frames, FrameTime::of_microseconds(mean));
  if (begins.size() != frames) return times;
  // The last frame lasts as long as the one before.
  for (std::size_t i = 0; i + 1 < frames; ++i) times[i] = FrameTime::of_microseconds(begins[i + 1] - begins[i]);
  if (frames > 1) times[frames - 1] = times[frames - 2];
  return times;
}

PictureSet with_frames(PictureSet set, std::uint64_t max_pixels) {
  if (set.is_directory || set.names.size() != 1 || set.files.size() != 1) return set;
  const MappedFileWatch watch;
  const auto cursor = std::make_shared<FrameCursor>(set.open(0), max_pixels);
  watch.check(set.files[0]);
  if (!cursor->reader()) {
    set.open = [cursor](std::size_t) { return cursor->file(); };  // standard input cannot be opened again
    return set;
  }
  const AnimationInfo info = cursor->reader()->info();
  PictureSet frames{.are_frames = true, .loops = info.loops, .has_alpha = info.has_alpha};
  for (std::size_t i = 0; i < info.frames; ++i) frames.names.push_back(fmt::format("frame {}", i + 1));
  frames.files = std::move(set.files);
  frames.open = [cursor](std::size_t i) {
    ImageFile file = cursor->file();
    file.name = fmt::format("{}, frame {}", file.name, i + 1);
    file.decode_frame = [cursor, i] { return picture_of(cursor->at(i).image); };
    file.frame_color = [cursor]() -> const ImageColor& { return cursor->color(); };
    return file;
  };
  frames.time_of = [cursor](std::size_t i) { return cursor->at(i).time; };
  return frames;
}

PictureSet open_pictures(const std::string& operand, const ProgramLimits& decoder) {
  if (is_video_name(operand) && !is_directory(operand)) return open_video(operand, decoder);
  PictureSet set{.is_directory = is_directory(operand)};
  PictureFiles files = set.is_directory ? PictureFiles{list_pictures_below(operand)} : list_pictures(operand);
  set.numbers = std::move(files.numbers);
  if (set.is_directory)
    for (const std::string& other : list_other_images(operand))
      set.others.push_back(fs::path(other).lexically_relative(operand).string());
  auto paths = std::make_shared<const std::vector<std::string>>(std::move(files.paths));
  for (const std::string& path : *paths)
    set.names.push_back(set.is_directory ? fs::path(path).lexically_relative(operand).string()
                                         : fs::path(path).filename().string());
  set.open = [paths](std::size_t i) { return open_image((*paths)[i]); };
  set.files = *paths;
  set.are_frames = are_frames(*paths);
  return set;
}

namespace {

std::vector<PicturePair> pair_by_order(const PictureSet& reference, const PictureSet& test) {
  std::vector<PicturePair> pairs;
  for (std::size_t i = 0; i < std::max(reference.names.size(), test.names.size()); ++i) {
    PicturePair pair;
    if (i < reference.names.size()) pair.reference = i;
    if (i < test.names.size()) pair.test = i;
    pair.name = pair.test ? test.names[i] : reference.names[i];
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// In the order of the numbers.
std::vector<PicturePair> pair_by_number(const PictureSet& reference, const PictureSet& test) {
  std::map<std::uint64_t, PicturePair> pairs;
  for (std::size_t i = 0; i < reference.names.size(); ++i)
    pairs[reference.numbers[i]] = {.name = reference.names[i], .reference = i, .test = {}};
  for (std::size_t i = 0; i < test.names.size(); ++i) {
    PicturePair& pair = pairs[test.numbers[i]];
    pair.test = i, pair.name = test.names[i];
  }
  std::vector<PicturePair> out;
  for (auto& [number, pair] : pairs) out.push_back(std::move(pair));
  return out;
}

std::vector<PicturePair> pair_by_path(const PictureSet& reference, const PictureSet& test) {
  std::vector<PicturePair> pairs;
  // The references that have no partner yet, by path and by path without extension.
  std::map<std::string, std::size_t> exact;
  std::multimap<std::string, std::size_t> loose;
  for (std::size_t i = 0; i < reference.names.size(); ++i) exact.emplace(reference.names[i], i);
  for (std::size_t i = 0; i < test.names.size(); ++i) {
    pairs.push_back({.name = test.names[i], .reference = {}, .test = i});
    if (const auto found = exact.find(test.names[i]); found != exact.end()) {
      pairs.back().reference = found->second;
      exact.erase(found);
    }
  }
  for (const auto& [name, index] : exact) loose.emplace(without_extension(name), index);
  for (PicturePair& pair : pairs) {
    if (pair.reference) continue;
    if (const auto found = loose.find(without_extension(pair.name)); found != loose.end()) {
      pair.reference = found->second;
      loose.erase(found);
    }
  }
  std::vector<std::size_t> missing;
  for (const auto& entry : loose) missing.push_back(entry.second);
  std::ranges::sort(missing);
  for (const std::size_t i : missing) pairs.push_back({.name = reference.names[i], .reference = i, .test = {}});
  return pairs;
}

}  // namespace

std::vector<PicturePair> pair_pictures(const PictureSet& reference, const PictureSet& test) {
  if (reference.is_directory && test.is_directory) return pair_by_path(reference, test);
  const bool are_numbered = !reference.numbers.empty() && !test.numbers.empty();
  return are_numbered ? pair_by_number(reference, test) : pair_by_order(reference, test);
}

}  // namespace zoneplate::metrics
