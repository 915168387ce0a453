// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/gif.h"
#include "zoneplate/codec/animated/webp_reader.h"
#include "zoneplate/codec/bitmap/bmp.h"
#include "zoneplate/codec/bitmap/tga.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/inspect/image_format.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/image/orientation.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate::metrics {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

template <class Code>
DisplayImage display_of(const Plane<Code>& codes) {
  constexpr float most = std::numeric_limits<decltype(Code::r)>::max();
  DisplayImage image(codes.width(), codes.height());
  std::ranges::transform(codes.values(), image.values().begin(), [](Code c) {
    return Display{static_cast<float>(c.r) / most, static_cast<float>(c.g) / most, static_cast<float>(c.b) / most,
                   static_cast<float>(c.a) / most};
  });
  return image;
}

DisplayImage decode_display(std::span<const std::uint8_t> bytes, const std::string& path, std::uint64_t max_pixels) {
  if (is_animated_webp(bytes)) return display_of(decode_first_webp_frame(bytes, path, max_pixels));
  if (is_webp(bytes)) return display_of(decode_webp(bytes, path, max_pixels));
  if (is_gif(bytes)) return display_of(decode_gif(bytes, path, max_pixels));
  if (is_bmp(bytes)) return display_of(decode_bmp(bytes, path, max_pixels));
  if (!is_png(bytes) && is_tga(bytes)) return display_of(decode_tga(bytes, path, max_pixels));
  if (!is_png(bytes))
    throw unread_format(bytes, path, "PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, BMP or TGA");
  const PngImage png = decode_png_as_stored(bytes, path, max_pixels);
  return png.pixels16.empty() ? display_of(png.pixels) : display_of(png.pixels16);
}

/// Natural order of names: runs of digits are compared as numbers.
bool comes_before(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [](const std::string& text, std::size_t& at) {
      while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
      const std::size_t start = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return text.substr(start, at - start);
    };
    const std::string p = number(a, i), q = number(b, j);
    if (p.size() != q.size()) return p.size() < q.size();
    if (p != q) return p < q;
  }
  return a.size() - i < b.size() - j;
}

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return extension;
}

constexpr std::string_view picture_endings[] = {".png",  ".apng", ".jpg", ".jpeg", ".webp", ".gif", ".tif", ".tiff",
                                                ".avif", ".jxl",  ".hdr", ".exr",  ".pfm",  ".bmp", ".tga"};

bool is_picture_name(const fs::path& path) {
  return std::ranges::find(picture_endings, lower_extension(path)) != std::end(picture_endings);
}

bool is_other_image_name(const fs::path& path) {
  constexpr std::string_view known[] = {".heic", ".ktx2", ".dds", ".webm", ".mp4", ".mov", ".mkv", ".avi", ".m4v"};
  return std::ranges::find(known, lower_extension(path)) != std::end(known);
}

/// The paths of a directory's files whose names `accepts(name)` accepts; `Iterator` decides about subfolders.
template <class Iterator = fs::directory_iterator, class Accepts>
std::vector<std::string> files_of(const fs::path& directory, const Accepts& accepts) {
  std::vector<std::string> paths;
  std::error_code error;
  for (Iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && accepts(entry->path().filename())) paths.push_back(entry->path().string());
  }
  if (error) throw Error(ErrorKind::Input, fmt::format("{}: {}", directory.string(), error.message()));
  std::ranges::sort(paths, comes_before);
  return paths;
}

/// The text before and after a frame's number in a file name, and the minimum number of digits.
struct FramePattern {
  std::string before, after;
  std::size_t digits = 1;

  /// The number in a name that matches.
  std::optional<std::uint64_t> number_in(const std::string& name) const {
    if (name.size() < before.size() + after.size() + digits) return std::nullopt;
    if (!name.starts_with(before) || !name.ends_with(after)) return std::nullopt;
    const std::string_view text(name.data() + before.size(), name.size() - before.size() - after.size());
    if (text.size() > digits && text.front() == '0') return std::nullopt;
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
  }
};

std::optional<FramePattern> frame_pattern(const std::string& name) {
  if (const std::size_t hash = name.find('#'); hash != std::string::npos) {
    const std::size_t end = std::min(name.size(), name.find_first_not_of('#', hash));
    return FramePattern{name.substr(0, hash), name.substr(end), end - hash};
  }
  const std::size_t percent = name.find('%');
  if (percent == std::string::npos) return std::nullopt;
  const std::size_t d = name.find_first_not_of("0123456789", percent + 1);
  if (d == std::string::npos || name[d] != 'd' || d - percent > 3) return std::nullopt;
  const std::size_t digits = d > percent + 1 ? std::stoul(name.substr(percent + 1, d - percent - 1)) : 1;
  return FramePattern{name.substr(0, percent), name.substr(d + 1), std::max<std::size_t>(1, digits)};
}

/// Requires at least one image in a directory.
std::vector<std::string> if_any(std::vector<std::string> paths, const std::string& directory) {
  if (paths.empty())
    throw Error(ErrorKind::Input, fmt::format("{}: the directory holds no {} file", directory, image_endings()));
  return paths;
}

/// The last numbers of the names, if these differ by them alone; else none.
std::vector<std::uint64_t> frame_numbers(const std::vector<std::string>& paths) {
  std::vector<std::uint64_t> numbers;
  if (!are_frames(paths)) return numbers;
  for (const std::string& path : paths) {
    const std::string name = fs::path(path).stem().string();
    const std::size_t last = name.find_last_of("0123456789");
    if (last == std::string::npos) return {};
    const std::size_t before = name.find_last_not_of("0123456789", last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    std::uint64_t number = 0;
    if (std::from_chars(name.data() + first, name.data() + last + 1, number).ec != std::errc()) return {};
    if (!numbers.empty() && number <= numbers.back()) return {};
    numbers.push_back(number);
  }
  return numbers;
}

/// Codes of a space and their light.
Picture picture_of(DisplayImage codes, const ImageColor& color) {
  codes = oriented(std::move(codes), color.orientation);
  if (!color.space || color.space->is_standard) return make_picture(std::move(codes));
  LinearImage light = light_of(codes, *color.space);
  return {std::move(codes), std::move(light)};
}

Picture picture_of(StoredImage image, const ImageColor& color) {
  return std::visit(
      [&]<class Pixel>(Plane<Pixel>& pixels) {
        if constexpr (std::is_same_v<Pixel, Linear>)
          return make_picture(oriented(std::move(pixels), color.orientation));
        else
          return picture_of(display_of(pixels), color);
      },
      image.pixels);
}

/// A frame with the colours that its animation states.
Picture picture_of_frame(const ImageFile& file) {
  const ImageColor& color = file.frame_color();
  Picture picture = picture_of(file.decode_frame().display, color);
  picture.space = color.space, picture.color_flaw = color.flaw;
  return picture;
}

}  // namespace

bool is_directory(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::string image_endings() {
  std::string text;
  for (const std::string_view& ending : picture_endings)
    text += (text.empty() ? "" : &ending == std::end(picture_endings) - 1 ? " or " : ", ") + std::string(ending);
  return text;
}

Picture picture_of(const TexelImage& codes) {
  return make_picture(codes.kind() == TexelKind::Codes16 ? display_of(codes.as<Rgba16>())
                                                         : display_of(codes.as<Rgba8>()));
}

Picture decode_picture(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                       const ExrChoice& exr) {
  ImageColor color = read_image_color(bytes, name, exr);
  Picture picture;
  if (const SystemFormat* const format = find_system_format(bytes)) {
    StoredImage image = format->decode(bytes, name, max_pixels);
    color = color_of(image, std::move(color), name);
    picture = picture_of(std::move(image), color);
  } else if (is_jpeg(bytes)) {
    JpegImage image = decode_jpeg(bytes, name, max_pixels);
    picture = picture_of(display_of(image.pixels), color);
    picture.flaw = std::move(image.flaw);
  } else {
    picture = is_hdr(bytes)   ? make_picture(decode_hdr(bytes, name, max_pixels))
              : is_exr(bytes) ? make_picture(decode_exr_as_stored(bytes, name, max_pixels, exr))
              : is_pfm(bytes) ? make_picture(decode_pfm(bytes, name, max_pixels))
                              : picture_of(decode_display(bytes, name, max_pixels), color);
  }
  picture.space = color.space, picture.color_flaw = color.flaw;
  return picture;
}

Picture in_srgb(Picture picture) {
  if (picture.space && !picture.space->is_standard) {
    convert_to_rec709(picture.linear, *picture.space);
    Picture converted = make_picture(std::move(picture.linear));
    picture.display = std::move(converted.display);
    picture.linear = picture.is_scene_linear ? std::move(converted.linear) : make_picture(picture.display).linear;
  }
  picture.space = nullptr;
  return picture;
}

ImageFile open_image(const std::string& path) {
  auto file = std::make_shared<const FileBytes>(path);
  const std::span<const std::uint8_t> bytes = file->bytes();
  return {.name = path, .bytes = bytes, .owner = std::move(file)};
}

Picture decode_file(const ImageFile& file, std::uint64_t max_pixels) {
  const MappedFileWatch watch;
  Picture picture =
      file.decode_frame ? in_srgb(picture_of_frame(file)) : decode_picture(file.bytes, file.name, max_pixels, file.exr);
  watch.check(file.name);
  return picture;
}

Picture load_picture(const std::string& path, std::uint64_t max_pixels) {
  return in_srgb(decode_file(open_image(path), max_pixels));
}

std::vector<std::string> list_pictures_below(const std::string& directory) {
  return if_any(files_of<fs::recursive_directory_iterator>(directory, is_picture_name), directory);
}

std::vector<std::string> list_other_images(const std::string& directory) {
  return files_of<fs::recursive_directory_iterator>(directory, is_other_image_name);
}

bool has_pictures(const std::string& directory) { return !files_of(fs::path(directory), is_picture_name).empty(); }

PictureFiles list_pictures(const std::string& operand) {
  const fs::path path(operand);
  if (is_directory(operand)) {
    PictureFiles files{if_any(files_of(path, is_picture_name), operand)};
    files.numbers = frame_numbers(files.paths);
    return files;
  }
  const auto pattern = frame_pattern(path.filename().string());
  std::error_code ignored;
  if (!pattern || fs::exists(path, ignored)) return {{operand}};
  const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const auto number_of = [&](const fs::path& file) { return pattern->number_in(file.filename().string()); };
  PictureFiles files{files_of(directory, number_of)};
  if (files.paths.empty()) throw Error(ErrorKind::Input, operand + ": no file has a number there");
  for (const std::string& file : files.paths) files.numbers.push_back(*number_of(file));
  return files;
}

bool are_frames(const std::vector<std::string>& paths) {
  const auto without_digits = [](const std::string& path) {
    std::string name = fs::path(path).filename().string();
    std::erase_if(name, is_digit);
    return name;
  };
  return paths.size() > 1 && std::ranges::all_of(paths, [&](const std::string& path) {
           return without_digits(path) == without_digits(paths.front());
         });
}

}  // namespace zoneplate::metrics
