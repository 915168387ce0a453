// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate::metrics {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

DisplayImage display_of(const Rgba8Image& codes) {
  DisplayImage image(codes.width(), codes.height());
  std::ranges::transform(codes.values(), image.values().begin(), [](Rgba8 c) {
    const auto unit = [](std::uint8_t code) { return static_cast<float>(code) / 255; };
    return Display{unit(c.r), unit(c.g), unit(c.b), unit(c.a)};
  });
  return image;
}

DisplayImage display_of(const Rgba16Image& codes) {
  DisplayImage image(codes.width(), codes.height());
  std::ranges::transform(codes.values(), image.values().begin(), [](Rgba16 c) {
    const auto unit = [](std::uint16_t code) { return static_cast<float>(code) / 65535; };
    return Display{unit(c.r), unit(c.g), unit(c.b), unit(c.a)};
  });
  return image;
}

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;

DisplayImage decode_display(std::span<const std::uint8_t> bytes, const std::string& path) {
  if (is_jpeg(bytes)) return display_of(decode_jpeg(bytes, path));
  if (is_webp(bytes)) return display_of(decode_webp(bytes, path, most_pixels));
  const PngImage png = decode_png(bytes, path);
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

bool is_picture_name(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  constexpr std::array<std::string_view, 7> known = {".png", ".jpg", ".jpeg", ".webp", ".hdr", ".exr", ".pfm"};
  return std::ranges::find(known, extension) != known.end();
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

  bool matches(const std::string& name) const {
    if (name.size() < before.size() + after.size() + digits) return false;
    if (!name.starts_with(before) || !name.ends_with(after)) return false;
    const std::string number = name.substr(before.size(), name.size() - before.size() - after.size());
    return std::ranges::all_of(number, is_digit) && (number.size() == digits || number.front() != '0');
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

bool is_directory(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// Requires at least one image in a directory.
std::vector<std::string> if_any(std::vector<std::string> paths, const std::string& directory) {
  if (paths.empty())
    throw Error(ErrorKind::Input,
                directory + ": the directory holds no .png, .jpg, .jpeg, .webp, .hdr, .exr or .pfm file");
  return paths;
}

}  // namespace

Picture decode_picture(std::span<const std::uint8_t> bytes, const std::string& name) {
  return is_hdr(bytes)   ? make_picture(decode_hdr(bytes, name))
         : is_exr(bytes) ? make_picture(decode_exr(bytes, name))
         : is_pfm(bytes) ? make_picture(decode_pfm(bytes, name))
                         : make_picture(decode_display(bytes, name));
}

Picture load_picture(const std::string& path) {
  const MappedFileWatch watch;
  const FileBytes file(path);
  Picture picture = decode_picture(file.bytes(), path);
  watch.check(path);
  return picture;
}

std::vector<std::string> list_pictures_below(const std::string& directory) {
  return if_any(files_of<fs::recursive_directory_iterator>(directory, is_picture_name), directory);
}

std::vector<std::string> list_pictures(const std::string& operand) {
  const fs::path path(operand);
  if (is_directory(operand)) return if_any(files_of(path, is_picture_name), operand);
  const auto pattern = frame_pattern(path.filename().string());
  std::error_code ignored;
  if (!pattern || fs::exists(path, ignored)) return {operand};
  const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<std::string> paths =
      files_of(directory, [&](const fs::path& name) { return pattern->matches(name.string()); });
  if (paths.empty()) throw Error(ErrorKind::Input, operand + ": no file has a number there");
  return paths;
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
