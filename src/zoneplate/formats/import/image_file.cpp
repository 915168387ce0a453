// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/gif.h"
#include "zoneplate/codec/animated/webp_reader.h"
#include "zoneplate/codec/bitmap/bmp.h"
#include "zoneplate/codec/bitmap/tga.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/inspect/image_format.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/ktx2/ktx2.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

int big_endian(std::span<const std::uint8_t> bytes, std::size_t at, int size) {
  std::uint32_t v = 0;
  for (int i = 0; i < size; ++i) v = v << 8 | bytes[at + static_cast<std::size_t>(i)];
  return static_cast<int>(std::min(v, std::uint32_t{0x7fffffff}));
}

/// The straight colour of a premultiplied one.
float4 straight(Linear c) {
  const float alpha = c.a > 0 ? c.a : 1.0f;
  return {c.r / alpha, c.g / alpha, c.b / alpha, c.a};
}

Plane<float4> decode_exr_light(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                               const std::string& layer) {
  Plane<float4> image;
  int y = 0;
  const auto take_row = [&](std::span<const Linear> row) {
    check_deadline();
    if (y == 0) image = Plane<float4>(static_cast<int>(row.size()), find_exr_size(bytes)->y);
    std::transform(row.begin(), row.end(), image.row(y++).begin(), [](const Linear& c) { return straight(c); });
  };
  decode_exr_rows(bytes, name, max_pixels, take_row, layer);
  return image;
}

Plane<float4> straight(const LinearImage& light) {
  Plane<float4> image(light.width(), light.height());
  std::ranges::transform(light.values(), image.values().begin(), [](const Linear& c) { return straight(c); });
  return image;
}

TexelImage texels_of(StoredImage image) {
  if (const auto* const light = std::get_if<LinearImage>(&image.pixels)) return straight(*light);
  if (auto* const codes = std::get_if<Rgba16Image>(&image.pixels)) return std::move(*codes);
  return std::get<Rgba8Image>(std::move(image.pixels));
}

TexelImage decode_png_texels(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  PngImage image = decode_png_as_stored(bytes, name, max_pixels);
  if (image.pixels16.empty()) return std::move(image.pixels);
  return std::move(image.pixels16);
}

}  // namespace

std::optional<int2> find_image_size(std::span<const std::uint8_t> bytes) {
  if (is_jpeg(bytes)) {
    const std::optional<JpegFrame> frame = read_jpeg_frame(bytes);
    return frame ? std::optional(frame->size) : std::nullopt;
  }
  if (is_webp(bytes)) return find_webp_size(bytes);
  if (is_hdr(bytes)) return find_hdr_size(bytes);
  if (is_exr(bytes)) return find_exr_size(bytes);
  if (is_ktx2(bytes)) return find_ktx2_size(bytes);
  if (is_pfm(bytes)) return find_pfm_size(bytes);
  if (is_gif(bytes)) return find_gif_size(bytes);
  if (const SystemFormat* const format = find_system_format(bytes)) return format->find_size(bytes);
  if (is_png(bytes) && bytes.size() >= 24) return int2{big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
  return is_bmp(bytes) ? find_bmp_size(bytes) : find_tga_size(bytes);
}

std::uint64_t decoded_image_memory(std::span<const std::uint8_t> bytes) {
  const std::optional<int2> size = find_image_size(bytes);
  if (!size) return 0;
  const std::uint64_t texel = is_ktx2(bytes)                                    ? ktx2_texel_memory(bytes)
                              : is_hdr(bytes) || is_exr(bytes) || is_pfm(bytes) ? sizeof(float4)
                              : is_png(bytes) && has_16_bits(bytes)             ? sizeof(Rgba16)
                              : find_system_format(bytes)                       ? sizeof(float4)
                                                                                : sizeof(Rgba8);
  return static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y) * texel;
}

std::uint64_t image_working_memory(std::span<const std::uint8_t> bytes) {
  const std::optional<int2> size = find_image_size(bytes);
  if (!size) return 0;
  const std::uint64_t pixels = static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y);
  if (is_exr(bytes)) return exr_working_memory(bytes);
  if (is_ktx2(bytes)) return ktx2_working_memory(bytes);
  if (is_pfm(bytes)) return pixels * sizeof(Linear);
  // Every pixel once more, and its alpha; of an animation, two images that its frames are drawn to.
  if (is_webp(bytes)) return (is_animated_webp(bytes) ? 13 : 5) * pixels;
  if (is_gif(bytes)) return 2 * sizeof(Rgba8) * pixels;
  if (find_system_format(bytes)) return sizeof(Linear) * pixels;
  if (!is_jpeg(bytes)) return 0;
  // libjpeg keeps all coefficients of a progressive image, two bytes each.
  const std::optional<JpegFrame> frame = read_jpeg_frame(bytes);
  return 2 * pixels * frame->samples / frame->pixels;
}

DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                          const std::string& layer) {
  if (is_jpeg(bytes)) {
    JpegImage image = decode_jpeg(bytes, name, max_pixels);
    return {std::move(image.pixels), std::move(image.flaw)};
  }
  if (is_animated_webp(bytes)) return {decode_first_webp_frame(bytes, name, max_pixels)};
  if (is_webp(bytes)) return {decode_webp(bytes, name, max_pixels)};
  if (is_gif(bytes)) return {decode_gif(bytes, name, max_pixels)};
  if (is_hdr(bytes)) return {decode_hdr_rgba(bytes, name, max_pixels)};
  if (is_exr(bytes)) return {decode_exr_light(bytes, name, max_pixels / 4, layer)};
  if (is_png(bytes)) return {decode_png_texels(bytes, name, max_pixels)};
  if (is_ktx2(bytes)) return {decode_ktx2(bytes, name, max_pixels)};
  if (is_pfm(bytes)) return {straight(decode_pfm(bytes, name, max_pixels))};
  if (const SystemFormat* const format = find_system_format(bytes))
    return {texels_of(format->decode(bytes, name, max_pixels))};
  if (is_bmp(bytes)) return {decode_bmp(bytes, name, max_pixels)};
  if (is_tga(bytes)) return {decode_tga(bytes, name, max_pixels)};
  throw unread_format(bytes, name, "PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, KTX2, BMP or TGA");
}

std::optional<std::string> size_warning(const TextureImage& image) {
  const int width = image.pixels.width(), height = image.pixels.height();
  int drawn_width = width, drawn_height = height;
  while (drawn_width > TextureImage::max_side) drawn_width /= 2;
  while (drawn_height > TextureImage::max_side) drawn_height /= 2;
  if (drawn_width == width && drawn_height == height) return std::nullopt;
  return fmt::format("texture {}: {} x {} texels are drawn as {} x {}, at most {} a side", image.name, width, height,
                     drawn_width, drawn_height, TextureImage::max_side);
}

}  // namespace zoneplate
