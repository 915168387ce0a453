// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/color_space.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>
#include <variant>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/color/icc.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

std::string_view text_in(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string joined(std::string a, const std::string& b) { return a + (a.empty() || b.empty() ? "" : ", ") + b; }

/// Two profiles are the same if their bytes are.
std::string icc_text(ByteSpan profile) {
  return fmt::format("ICC profile of {} bytes (checksum {:08x})", profile.size(), png_checksum(0, profile));
}

/// The orientation of Exif data, which is a TIFF file; 1, the upright one, if it states none.
int orientation_in(ByteSpan tiff) {
  if (tiff.size() < 8) return 1;
  const bool is_big = tiff[0] == 'M';
  const auto number = [&](std::size_t at, std::size_t size) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | tiff[at + (is_big ? i : size - 1 - i)];
    return value;
  };
  const std::size_t directory = number(4, 4);
  if (directory > tiff.size() || tiff.size() - directory < 2) return 1;
  constexpr std::size_t entry = 12, orientation = 0x112, type_long = 4;
  const std::size_t entries = std::min(number(directory, 2), (tiff.size() - directory - 2) / entry);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + i * entry;
    if (number(at, 2) != orientation) continue;
    const std::size_t value = number(at + 8, number(at + 2, 2) == type_long ? 4 : 2);
    return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
  }
  return 1;
}

/// Exif data of a file whose container already says that it is; some programs repeat JPEG's prefix.
int orientation_after_prefix(ByteSpan exif) {
  constexpr std::string_view prefix("Exif\0\0", 6);
  return orientation_in(text_in(exif).starts_with(prefix) ? exif.subspan(prefix.size()) : exif);
}

/// The profile of an iCCP chunk: a name, a zero, the method 0, and a zlib stream.
void inflate_profile(ByteSpan chunk, FileColor& out) {
  const auto name_end = std::ranges::find(chunk, 0);
  if (chunk.end() - name_end < 3) {
    out.profile.icc.assign(chunk.begin(), chunk.end());
    out.profile_flaw = "is cut off";
    return;
  }
  const ByteSpan packed = chunk.subspan(static_cast<std::size_t>(name_end - chunk.begin()) + 2);
  uLongf size = max_icc_bytes;
  out.profile.icc.resize(size);
  const int result = uncompress(out.profile.icc.data(), &size, packed.data(), static_cast<uLong>(packed.size()));
  if (result == Z_OK) return out.profile.icc.resize(size);
  // Of a profile that is damaged or too large, the packed bytes are compared.
  out.profile.icc.assign(packed.begin(), packed.end());
  out.profile_flaw = result == Z_BUF_ERROR && size == max_icc_bytes
                         ? fmt::format("has more than {} bytes, which are not read", max_icc_bytes)
                         : "is damaged: its packed bytes are no whole zlib stream";
}

constexpr std::uint32_t srgb_primaries[] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
constexpr std::array<std::uint8_t, 4> srgb_cicp = {1, 13, 0, 1};

bool is_near(std::uint32_t a, std::uint32_t b) { return (a > b ? a - b : b - a) <= 10; }

/// Gamma and primaries in units of 1/100000.
std::string gamma_text(const ColorProfile& profile) {
  constexpr std::uint32_t srgb_gamma = 45455;
  std::string text;
  if (profile.gamma && !is_near(*profile.gamma, srgb_gamma)) text = fmt::format("gAMA {:g}", *profile.gamma / 100000.0);
  if (!profile.primaries || std::ranges::equal(*profile.primaries, srgb_primaries, is_near)) return text;
  std::string values = "cHRM";
  for (const std::uint32_t value : *profile.primaries) values += fmt::format(" {:g}", value / 100000.0);
  return joined(text, values);
}

std::string text_of(const ColorProfile& profile) {
  if (const auto& c = profile.cicp)
    return *c == srgb_cicp ? "" : fmt::format("cICP {}/{}/{}/{}", (*c)[0], (*c)[1], (*c)[2], (*c)[3]);
  return profile.icc.empty() ? gamma_text(profile) : icc_text(profile.icc);
}

FileColor of_png(ByteSpan file) {
  std::map<std::string_view, ByteSpan> chunks;
  for_png_chunks(file, [&](std::string_view name, ByteSpan data) {
    chunks.emplace(name, data);
    return name != "IEND";
  });
  const auto has = [&](std::string_view name, std::size_t size) {
    return chunks.contains(name) && chunks[name].size() == size;
  };
  FileColor out;
  constexpr std::uint8_t has_color = 2;
  out.is_grey = file.size() > 25 && (file[25] & has_color) == 0;
  out.orientation = orientation_after_prefix(chunks["eXIf"]);
  if (has("cICP", 4)) std::ranges::copy(chunks["cICP"], out.profile.cicp.emplace().begin());
  if (!chunks["iCCP"].empty()) {
    inflate_profile(chunks["iCCP"], out);
  } else if (has("sRGB", 1)) {
    return out;  // gAMA and cHRM repeat it for older programs
  }
  if (has("gAMA", 4)) out.profile.gamma = get_png_word(chunks["gAMA"]);
  if (has("cHRM", 4 * std::size(srgb_primaries))) {
    auto& values = out.profile.primaries.emplace();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = get_png_word(chunks["cHRM"].subspan(4 * i));
  }
  return out;
}

/// TIFF and AVIF. What is unspecified of code points is that of sRGB.
FileColor of_tags(const ColorTags& tags) {
  FileColor out;
  out.is_grey = tags.is_grey;
  out.profile.icc.assign(tags.profile.begin(), tags.profile.end());
  if (!tags.cicp || !tags.profile.empty()) return out;
  constexpr std::uint8_t unspecified = 2;
  std::array<std::uint8_t, 4> cicp = srgb_cicp;
  for (std::size_t i = 0; i < tags.cicp->size(); ++i)
    if ((*tags.cicp)[i] != unspecified) cicp[i] = (*tags.cicp)[i];
  if (cicp != srgb_cicp) out.profile.cicp = cicp;
  return out;
}

/// Calls `take(marker, data)` for each segment of a JPEG before its first scan. Other bytes between segments, and those
/// of 0xff that fill up to a marker, are skipped, as libjpeg does.
///
/// Source    ITU-T T.81, B.1.1.2 and table B.1.
template <class Take>
void for_jpeg_segments(ByteSpan file, const Take& take) {
  constexpr std::uint8_t mark = 0xff, stuffed = 0, temporary = 1, first_restart = 0xd0, start_of_image = 0xd8;
  constexpr std::uint8_t end_of_image = 0xd9, start_of_scan = 0xda;
  for (std::size_t at = 0; at < file.size();) {
    if (file[at++] != mark) continue;
    while (at < file.size() && file[at] == mark) ++at;
    if (at == file.size()) return;
    const std::uint8_t marker = file[at++];
    if (marker == stuffed || marker == temporary || (marker >= first_restart && marker <= start_of_image)) continue;
    if (marker == end_of_image || marker == start_of_scan || file.size() - at < 2) return;
    const std::size_t size = std::size_t{file[at]} << 8 | file[at + 1];
    if (size < 2 || file.size() - at < size) return;
    take(marker, file.subspan(at + 2, size - 2));
    at += size;
  }
}

/// The profile lies in parts in several APP2 segments, numbered from 1.
FileColor of_jpeg(ByteSpan file) {
  FileColor out;
  std::map<int, ByteSpan> parts;
  constexpr std::string_view icc("ICC_PROFILE\0", 12), exif("Exif\0\0", 6);
  constexpr std::uint8_t app1 = 0xe1, app2 = 0xe2, first_frame = 0xc0, last_frame = 0xcf;
  for_jpeg_segments(file, [&](std::uint8_t marker, ByteSpan data) {
    if (marker == app2 && text_in(data).starts_with(icc) && data.size() > icc.size() + 2)
      parts.emplace(data[icc.size()], data.subspan(icc.size() + 2));
    if (marker == app1 && text_in(data).starts_with(exif)) out.orientation = orientation_in(data.subspan(exif.size()));
    // The components of a frame's header; between them are tables (DHT, JPG, DAC).
    const bool is_frame =
        marker >= first_frame && marker <= last_frame && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame && data.size() > 5) out.is_grey = data[5] == 1;
  });
  for (const auto& [number, part] : parts) out.profile.icc.insert(out.profile.icc.end(), part.begin(), part.end());
  return out;
}

FileColor of_webp(ByteSpan file) {
  FileColor out;
  for (std::size_t at = 12; file.size() >= at + 8;) {
    const std::size_t size = file[at + 4] | std::size_t{file[at + 5]} << 8 | std::size_t{file[at + 6]} << 16 |
                             std::size_t{file[at + 7]} << 24;
    if (file.size() - at - 8 < size) break;
    const ByteSpan data = file.subspan(at + 8, size);
    const std::string_view name = text_in(file.subspan(at, 4));
    if (name == "ICCP") out.profile.icc.assign(data.begin(), data.end());
    if (name == "EXIF") out.orientation = orientation_after_prefix(data);
    at += 8 + size + size % 2;
  }
  return out;
}

std::string of_hdr(ByteSpan file) {
  std::string text;
  const std::string_view all = text_in(file.first(std::min(file.size(), std::size_t{1} << 16)));
  const std::string_view header = all.substr(0, all.find("\n\n"));
  for (std::size_t at = 0; at < header.size();) {
    const std::size_t end = std::min(header.size(), header.find('\n', at));
    const std::string_view line = header.substr(at, end - at);
    for (const std::string_view name : {"EXPOSURE=", "COLORCORR=", "PRIMARIES=", "GAMMA="})
      if (line.starts_with(name)) text = joined(text, std::string(line));
    at = end + 1;
  }
  return text;
}

/// The magnitude of the scale, the third number of the header.
std::string of_pfm(ByteSpan file) {
  const std::string head(text_in(file.first(std::min(file.size(), std::size_t{256}))));
  int width = 0, height = 0;
  double scale = 0;
  if (std::sscanf(head.c_str(), "P%*c %d %d %lf", &width, &height, &scale) != 3) return {};
  return scale == 1 || scale == -1 ? "" : fmt::format("scale {:g}", scale < 0 ? -scale : scale);
}

FileColor of_exr(const ExrPart& part) {
  FileColor out;
  const auto& stated = part.chromaticities;
  if (stated && !std::ranges::equal(*stated, rec709_chromaticities)) out.profile.chromaticities = stated;
  return out;
}

/// The part of a layer of an EXR.
struct ChosenPart {
  ExrPart part;
  bool has_colors = false;  ///< in the layer
};

/// Nothing if the header is wrong.
std::optional<ChosenPart> choose_part(ByteSpan bytes, const std::string& name, const ExrChoice& choice) {
  std::vector<ExrPart> parts = read_exr_parts(bytes);
  if (parts.empty()) return std::nullopt;
  const ExrLayer layer = choose_exr_layer(parts, choice.layer, name);
  return ChosenPart{std::move(parts[static_cast<std::size_t>(layer.part)]), layer.has_colors};
}

}  // namespace

FileColor read_file_color(ByteSpan bytes) {
  if (is_png(bytes)) return of_png(bytes);
  if (is_jpeg(bytes)) return of_jpeg(bytes);
  if (is_webp(bytes)) return of_webp(bytes);
  if (const SystemFormat* const format = find_system_format(bytes))
    return format->find_colors ? of_tags(format->find_colors(bytes)) : FileColor{};
  FileColor out;
  if (is_hdr(bytes)) out.scale = of_hdr(bytes);
  if (is_pfm(bytes)) out.scale = of_pfm(bytes);
  const std::optional<ExrPart> part = read_exr_part(bytes);
  return part ? of_exr(*part) : out;
}

std::string color_space_of(ByteSpan bytes, const std::string& name, const ExrChoice& exr) {
  if (is_exr(bytes)) {
    // The text of an EXR has other attributes, too.
    const std::optional<ChosenPart> chosen = choose_part(bytes, name, exr);
    return chosen ? chosen->part.color_space : std::string();
  }
  const FileColor color = read_file_color(bytes);
  return joined(text_of(color.profile), color.scale);
}

namespace {

/// `code_points` is what a message calls those of the file.
ImageColor color_of_file(FileColor file, const char* code_points, const std::string& name) {
  ImageColor out{.space = nullptr, .orientation = file.orientation};
  if (file.profile.empty()) return out;
  const bool is_icc = !file.profile.icc.empty() && !file.profile.cicp,
             is_light = file.profile.chromaticities.has_value();
  if (is_icc && file.profile_flaw.empty()) open_icc_library(name);
  try {
    if (!is_icc) {
      if (RgbSpacePtr space = make_rgb_space(file.profile)) {
        RgbSpace named = *space;
        named.name = is_light ? "its chromaticities" : text_of(file.profile);
        out.space = std::make_shared<const RgbSpace>(std::move(named));
      }
      return out;
    }
    if (!file.profile_flaw.empty()) throw Error(ErrorKind::Input, file.profile_flaw);
    RgbSpace space = read_icc_space(file.profile.icc, file.is_grey);
    space.name = fmt::format("the ICC profile '{}'", space.name);
    space.profile = std::move(file.profile);
    recognize_standard(space);
    out.space = std::make_shared<const RgbSpace>(std::move(space));
  } catch (const Error& error) {
    const char* const what = is_icc               ? "ICC profile"
                             : file.profile.cicp  ? code_points
                             : is_light           ? "chromaticities attribute"
                             : file.profile.gamma ? "gAMA chunk"
                                                  : "cHRM chunk";
    out.flaw = fmt::format("{}: its {} {}; the image is taken as {}", name, what, error.what(),
                           is_light ? "light of Rec.709 primaries" : "sRGB");
  }
  return out;
}

}  // namespace

ImageColor read_image_color(ByteSpan bytes, const std::string& name, const ExrChoice& exr) {
  FileColor file;
  if (!is_exr(bytes))
    file = read_file_color(bytes);
  else if (const std::optional<ChosenPart> chosen = choose_part(bytes, name, exr); chosen && chosen->has_colors)
    file = of_exr(chosen->part);
  return color_of_file(std::move(file), is_png(bytes) ? "cICP chunk" : "code points (nclx)", name);
}

ImageColor color_of(const StoredImage& image, ImageColor stated, const std::string& name) {
  if (!image.profile.empty()) {
    FileColor found{.profile = {.icc = image.profile}};
    found.is_grey = icc_pixels(image.profile) == "GRAY";
    stated = color_of_file(std::move(found), "", name);
  }
  stated.orientation = image.orientation;
  if (!std::holds_alternative<LinearImage>(image.pixels) || !stated.space) return stated;
  if (!stated.space->is_standard)
    stated.flaw = fmt::format("{}: has {}, which is not applied to light: it is taken as light of Rec.709 primaries",
                              name, stated.space->name);
  stated.space = nullptr;
  return stated;
}

}  // namespace zoneplate
