// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/image_format.h"

#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/codec/bitmap/tga.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

/// A text that identifies a format, and where it is.
struct Signature {
  std::size_t at;
  std::string_view text, name;
};

constexpr std::string_view ktx1 = "\xabKTX 11", ktx2 = "\xabKTX 20", jpeg_xl = "\xff\x0a";

constexpr Signature signatures[] = {
    {0, "GIF8", "a GIF"},           {0, "BM", "a BMP"},          {0, {"II*\0", 4}, "a TIFF"},
    {0, {"MM\0*", 4}, "a TIFF"},    {0, {"II+\0", 4}, "a TIFF"}, {0, {"MM\0+", 4}, "a TIFF"},
    {4, "ftypavif", "an AVIF"},     {4, "ftypavis", "an AVIF"},  {4, "ftyphei", "a HEIC"},
    {4, "ftyphev", "a HEIC"},       {4, "ftypmif1", "a HEIC"},   {0, jpeg_xl, "a JPEG XL"},
    {4, "JXL ", "a JPEG XL"},       {4, "jP  ", "a JPEG 2000"},  {0, "8BPS", "a PSD"},
    {0, "DDS ", "a DDS"},           {0, ktx1, "a KTX 1"},        {0, ktx2, "a KTX2"},
    {0, "qoif", "a QOI"},           {0, "SDPX", "a DPX"},        {0, "XPDS", "a DPX"},
    {0, {"\0\0\1\0", 4}, "an ICO"}, {0, "<svg", "an SVG"},
};

bool has_text_at(std::span<const std::uint8_t> bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char c, std::uint8_t b) { return static_cast<std::uint8_t>(c) == b; });
}

}  // namespace

std::string_view format_of_image(std::span<const std::uint8_t> bytes) {
  if (is_png(bytes)) return "a PNG";
  if (is_jpeg(bytes)) return "a JPEG";
  if (is_webp(bytes)) return "a WebP";
  if (is_hdr(bytes)) return "an HDR";
  if (is_exr(bytes)) return "an EXR";
  if (is_pfm(bytes)) return "a PFM";
  for (const Signature& known : signatures)
    if (has_text_at(bytes, known.at, known.text)) return known.name;
  if (is_tga(bytes)) return "a TGA";
  return "no known";
}

Error unread_format(std::span<const std::uint8_t> bytes, const std::string& name, std::string_view expected) {
  return {ErrorKind::Input, fmt::format("{}: is {} image, expected {}", name, format_of_image(bytes), expected)};
}

std::uint32_t count_frames(std::span<const std::uint8_t> bytes) {
  std::uint32_t frames = 1;
  if (is_png(bytes))
    for_png_chunks(bytes, [&](std::string_view name, std::span<const std::uint8_t> data) {
      if (name == "acTL" && data.size() >= 4) frames = get_png_word(data);
      return name != "IDAT";
    });
  return std::max(frames, std::uint32_t{1});
}

}  // namespace zoneplate
