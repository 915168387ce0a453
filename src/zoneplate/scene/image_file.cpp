#include "zoneplate/scene/image_file.h"

#include <algorithm>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/image/exr.h"
#include "zoneplate/image/hdr.h"
#include "zoneplate/image/jpeg.h"
#include "zoneplate/image/png.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/image/webp_still.h"

namespace zoneplate {
namespace {

bool has_text(std::span<const std::uint8_t> bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char c, std::uint8_t b) { return static_cast<std::uint8_t>(c) == b; });
}

bool is_png(std::span<const std::uint8_t> bytes) { return has_text(bytes, 0, "\x89PNG\r\n\x1a\n"); }
bool is_jpeg(std::span<const std::uint8_t> bytes) { return has_text(bytes, 0, "\xff\xd8\xff"); }

bool is_webp(std::span<const std::uint8_t> bytes) { return has_text(bytes, 0, "RIFF") && has_text(bytes, 8, "WEBP"); }

/// The name of a format that is not read.
std::string_view known_format(std::span<const std::uint8_t> bytes) {
  if (has_text(bytes, 1, "KTX ")) return "a KTX";
  if (has_text(bytes, 0, "DDS ")) return "a DDS";
  if (has_text(bytes, 0, "GIF8")) return "a GIF";
  if (has_text(bytes, 4, "ftypavif")) return "an AVIF";
  if (has_text(bytes, 0, "BM")) return "a BMP";
  return "no known";
}

int big_endian(std::span<const std::uint8_t> bytes, std::size_t at, int size) {
  std::uint32_t v = 0;
  for (int i = 0; i < size; ++i) v = v << 8 | bytes[at + static_cast<std::size_t>(i)];
  return static_cast<int>(std::min(v, std::uint32_t{0x7fffffff}));
}

/// Walks over a JPEG's segments to the frame header (ITU-T T.81, B.2); what stands between segments is passed over, as
/// libjpeg does.
std::optional<int2> find_jpeg_size(std::span<const std::uint8_t> bytes) {
  for (std::size_t at = 2; at + 9 <= bytes.size();) {
    const std::uint8_t marker = bytes[at + 1];
    const bool is_marker = bytes[at] == 0xff && marker != 0xff && marker != 0;
    const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_marker && is_frame) return int2{big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
    const bool is_bare = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd9);
    at += !is_marker ? 1 : is_bare ? 2 : 2 + static_cast<std::size_t>(big_endian(bytes, at + 2, 2));
  }
  return std::nullopt;
}

/// 16-bit codes as 8-bit ones: round(code * 255 / 65535).
Rgba8Image narrow(const Rgba16Image& wide) {
  Rgba8Image out(wide.width(), wide.height());
  const auto to8 = [](std::uint16_t v) { return static_cast<std::uint8_t>((std::uint32_t{v} + 128) / 257); };
  std::transform(wide.values().begin(), wide.values().end(), out.values().begin(), [&](Rgba16 p) {
    return Rgba8{to8(p.r), to8(p.g), to8(p.b), to8(p.a)};
  });
  return out;
}

Rgba8Image codes_of(const LinearImage& light) {
  Rgba8Image out(light.width(), light.height());
  std::transform(light.values().begin(), light.values().end(), out.values().begin(), [](Linear c) {
    if (!(c.a > 0)) return Rgba8{0, 0, 0, 0};
    const float alpha = std::min(c.a, 1.0f);
    return Rgba8{encode_srgb8(c.r / c.a), encode_srgb8(c.g / c.a), encode_srgb8(c.b / c.a),
                 static_cast<std::uint8_t>(alpha * 255 + 0.5f)};
  });
  return out;
}

}  // namespace

std::optional<int2> find_image_size(std::span<const std::uint8_t> bytes) {
  if (is_jpeg(bytes)) return find_jpeg_size(bytes);
  if (is_webp(bytes)) return find_webp_size(bytes);
  if (is_hdr(bytes)) return find_hdr_size(bytes);
  if (is_exr(bytes)) return find_exr_size(bytes);
  if (is_png(bytes) && bytes.size() >= 24) return int2{big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
  return std::nullopt;
}

Rgba8Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  if (is_jpeg(bytes)) return decode_jpeg(bytes, name, max_pixels);
  if (is_webp(bytes)) return decode_webp(bytes, name, max_pixels);
  if (is_hdr(bytes)) return codes_of(decode_hdr(bytes, name, max_pixels / 4));
  if (is_exr(bytes)) return codes_of(decode_exr(bytes, name, max_pixels / 4));
  if (!is_png(bytes))
    throw Error(Trouble::Input,
                name + ": is " + std::string(known_format(bytes)) + " image, wants PNG, JPEG, WebP, HDR or EXR");
  PngImage png = decode_png(bytes, name, max_pixels);
  return png.pixels16.empty() ? std::move(png.pixels) : narrow(png.pixels16);
}

}  // namespace zoneplate
