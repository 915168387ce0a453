// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/picture_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate::metrics {
namespace {

namespace fs = std::filesystem;

bool is_directory(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_video_name(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  constexpr std::array<std::string_view, 8> known = {".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi", ".gif", ".apng"};
  return std::ranges::find(known, extension) != known.end();
}

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

/// The frames of a video, which are kept as PNG files in memory.
PictureSet open_video(const std::string& path, const ProgramLimits& limits) {
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(ErrorKind::Input, path + ": no such file");
  check_is_file(path);
  auto stream = std::make_shared<std::vector<std::uint8_t>>();
  try {
    ProgramResult result = run_child("ffmpeg",
                                     {"-v",
                                      "error",
                                      "-nostdin",
                                      "-i",
                                      "file:" + path,
                                      "-map",
                                      "0:v:0",
                                      "-vsync",
                                      "passthrough",
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
                                     "", limits);
    if (result.code != 0)
      throw Error(ErrorKind::Input, result.complaint.empty() ? "ffmpeg cannot read it" : "ffmpeg: " + result.complaint);
    *stream = std::move(result.out);
  } catch (const Error& reason) {
    throw Error(ErrorKind::Input, fmt::format("{}: {}", path, reason.what()));
  }
  const auto images = split_png_stream(*stream);
  if (images.empty()) throw Error(ErrorKind::Input, path + ": the video has no frame");
  PictureSet set{.are_frames = true};
  for (std::size_t i = 0; i < images.size(); ++i) set.names.push_back(fmt::format("frame {}", i + 1));
  set.open = [stream, images, path](std::size_t i) {
    return ImageFile{fmt::format("{}, frame {}", path, i + 1), images[i], stream};
  };
  return set;
}

std::string without_extension(const std::string& path) { return fs::path(path).replace_extension().string(); }

}  // namespace

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
