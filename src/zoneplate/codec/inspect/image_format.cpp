// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/image_format.h"

#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/codec/animated/gif.h"
#include "zoneplate/codec/bitmap/tga.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/avif.h"
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/system/tiff.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

/// A text that identifies a format, and where it is.
struct Signature {
  std::size_t at;
  std::string_view text, name;
};

constexpr std::string_view ktx1 = "\xabKTX 11", ktx2 = "\xabKTX 20";

constexpr Signature signatures[] = {
    {0, "BM", "a BMP"},
    {4, "ftyphei", "a HEIC"},
    {4, "ftyphev", "a HEIC"},
    {4, "ftypmif1", "a HEIC"},
    {4, "jP  ", "a JPEG 2000"},
    {0, "8BPS", "a PSD"},
    {0, "DDS ", "a DDS"},
    {0, ktx1, "a KTX 1"},
    {0, ktx2, "a KTX2"},
    {0, "qoif", "a QOI"},
    {0, "SDPX", "a DPX"},
    {0, "XPDS", "a DPX"},
    {0, {"\0\0\1\0", 4}, "an ICO"},
    {0, "<svg", "an SVG"},
    {0, "\x1a\x45\xdf\xa3", "a Matroska video"},
    {4, "ftypqt  ", "a QuickTime video"},
    {8, "AVI LIST", "an AVI video"},
    {4, "ftyp", "an MP4 video"},
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
  if (is_gif(bytes)) return "a GIF";
  if (is_tiff(bytes)) return "a TIFF";
  if (is_avif(bytes)) return "an AVIF";
  if (is_jxl(bytes)) return "a JPEG XL";
  for (const Signature& known : signatures)
    if (has_text_at(bytes, known.at, known.text)) return known.name;
  if (is_tga(bytes)) return "a TGA";
  return "no known";
}

/// "a PSD image", "an MP4 video".
static std::string found_image(std::span<const std::uint8_t> bytes) {
  const std::string_view format = format_of_image(bytes);
  return std::string(format) + (format.ends_with(" video") ? "" : " image");
}

Error unread_format(std::span<const std::uint8_t> bytes, const std::string& name, std::string_view expected) {
  return {ErrorKind::Input, fmt::format("{}: is {}, expected {}", name, found_image(bytes), expected)};
}

}  // namespace zoneplate
