// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/color_space.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string_view>
#include <vector>

#include "zoneplate/codec/exr_header.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

std::string_view text_in(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string joined(std::string a, const std::string& b) { return a + (a.empty() || b.empty() ? "" : ", ") + b; }

/// Two profiles are the same if their bytes are.
std::string profile_text(ByteSpan profile) {
  if (profile.empty()) return {};
  return fmt::format("ICC profile of {} bytes (checksum {:08x})", profile.size(), png_checksum(0, profile));
}

/// The orientation of Exif data, which is a TIFF file; empty for 1, the upright one.
std::string orientation_text(ByteSpan tiff) {
  if (tiff.size() < 8) return {};
  const bool is_big = tiff[0] == 'M';
  const auto number = [&](std::size_t at, std::size_t size) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | tiff[at + (is_big ? i : size - 1 - i)];
    return value;
  };
  const std::size_t directory = number(4, 4);
  if (directory > tiff.size() || tiff.size() - directory < 2) return {};
  constexpr std::size_t entry = 12, orientation = 0x112;
  const std::size_t entries = std::min(number(directory, 2), (tiff.size() - directory - 2) / entry);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + i * entry;
    if (number(at, 2) == orientation && number(at + 8, 2) != 1)
      return fmt::format("Exif orientation {}", number(at + 8, 2));
  }
  return {};
}

/// The profile of an iCCP chunk: a name, a zero, the method 0, and a zlib stream.
std::vector<std::uint8_t> inflated_profile(ByteSpan chunk) {
  const auto name_end = std::ranges::find(chunk, 0);
  if (chunk.end() - name_end < 3) return {};
  const ByteSpan packed = chunk.subspan(static_cast<std::size_t>(name_end - chunk.begin()) + 2);
  constexpr uLongf most = 1 << 22;
  std::vector<std::uint8_t> profile(most);
  uLongf size = most;
  // Of a profile that is damaged or too large, the packed bytes are compared.
  if (uncompress(profile.data(), &size, packed.data(), static_cast<uLong>(packed.size())) != Z_OK)
    return {packed.begin(), packed.end()};
  profile.resize(size);
  return profile;
}

/// Gamma and primaries in units of 1/100000.
std::string gamma_text(ByteSpan gamma, ByteSpan primaries) {
  const auto is_near = [](std::uint32_t a, std::uint32_t b) { return (a > b ? a - b : b - a) <= 10; };
  constexpr std::uint32_t srgb_gamma = 45455;
  constexpr std::uint32_t srgb[] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};  // white, red, green, blue
  std::string text;
  if (gamma.size() == 4 && !is_near(get_png_word(gamma), srgb_gamma))
    text = fmt::format("gAMA {:g}", get_png_word(gamma) / 100000.0);
  if (primaries.size() != 4 * std::size(srgb)) return text;
  bool is_srgb = true;
  std::string values = "cHRM";
  for (std::size_t i = 0; i < std::size(srgb); ++i) {
    const std::uint32_t value = get_png_word(primaries.subspan(4 * i));
    is_srgb = is_srgb && is_near(value, srgb[i]);
    values += fmt::format(" {:g}", value / 100000.0);
  }
  return is_srgb ? text : joined(text, values);
}

std::string of_png(ByteSpan file) {
  std::map<std::string_view, ByteSpan> chunks;
  for_png_chunks(file, [&](std::string_view name, ByteSpan data) {
    chunks.emplace(name, data);
    return name != "IEND";
  });
  const auto has = [&](std::string_view name) { return chunks.contains(name); };
  std::string text;
  if (has("cICP") && chunks["cICP"].size() == 4) {
    const ByteSpan c = chunks["cICP"];
    const bool is_srgb = c[0] == 1 && c[1] == 13 && c[2] == 0 && c[3] == 1;
    if (!is_srgb) text = fmt::format("cICP {}/{}/{}/{}", c[0], c[1], c[2], c[3]);
  } else if (has("iCCP")) {
    text = profile_text(inflated_profile(chunks["iCCP"]));
  } else if (!has("sRGB")) {
    text = gamma_text(chunks["gAMA"], chunks["cHRM"]);
  }
  return joined(text, orientation_text(chunks["eXIf"]));
}

/// The profile lies in parts in several APP2 segments, numbered from 1.
std::string of_jpeg(ByteSpan file) {
  std::map<int, ByteSpan> parts;
  std::string orientation;
  constexpr std::string_view icc("ICC_PROFILE\0", 12), exif("Exif\0\0", 6);
  constexpr std::uint8_t app1 = 0xe1, app2 = 0xe2, start_of_scan = 0xda;
  for (std::size_t at = 2; file.size() >= at + 4 && file[at] == 0xff && file[at + 1] != start_of_scan;) {
    const std::size_t size = std::size_t{file[at + 2]} << 8 | file[at + 3];
    if (size < 2 || file.size() - at - 2 < size) break;
    const ByteSpan data = file.subspan(at + 4, size - 2);
    if (file[at + 1] == app2 && text_in(data).starts_with(icc) && data.size() > icc.size() + 2)
      parts.emplace(data[icc.size()], data.subspan(icc.size() + 2));
    if (file[at + 1] == app1 && text_in(data).starts_with(exif))
      orientation = orientation_text(data.subspan(exif.size()));
    at += 2 + size;
  }
  std::vector<std::uint8_t> profile;
  for (const auto& [number, part] : parts) profile.insert(profile.end(), part.begin(), part.end());
  return joined(profile_text(profile), orientation);
}

std::string of_webp(ByteSpan file) {
  std::string text;
  for (std::size_t at = 12; file.size() >= at + 8;) {
    const std::size_t size = file[at + 4] | std::size_t{file[at + 5]} << 8 | std::size_t{file[at + 6]} << 16 |
                             std::size_t{file[at + 7]} << 24;
    if (file.size() - at - 8 < size) break;
    const ByteSpan data = file.subspan(at + 8, size);
    const std::string_view name = text_in(file.subspan(at, 4));
    if (name == "ICCP") text = joined(text, profile_text(data));
    if (name == "EXIF") text = joined(text, orientation_text(data));
    at += 8 + size + size % 2;
  }
  return text;
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

}  // namespace

std::string color_space_of(std::span<const std::uint8_t> bytes) {
  if (is_png(bytes)) return of_png(bytes);
  if (is_jpeg(bytes)) return of_jpeg(bytes);
  if (is_webp(bytes)) return of_webp(bytes);
  if (is_hdr(bytes)) return of_hdr(bytes);
  if (is_pfm(bytes)) return of_pfm(bytes);
  const std::optional<ExrPart> part = read_exr_part(bytes);
  return part ? part->color_space : "";
}

}  // namespace zoneplate
