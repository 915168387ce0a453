// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/webp_still.h"

#include <webp/decode.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate {

bool is_webp(std::span<const std::uint8_t> bytes) {
  const auto has = [&](std::size_t at, std::string_view text) {
    return std::equal(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  };
  return bytes.size() >= 12 && has(0, "RIFF") && has(8, "WEBP");
}

std::optional<int2> find_webp_size(std::span<const std::uint8_t> bytes) {
  int2 size;
  if (WebPGetInfo(bytes.data(), bytes.size(), &size.x, &size.y) == 0) return std::nullopt;
  return size;
}

Rgba8Image decode_webp(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  const auto fail = [&](const std::string& cause) { throw Error(ErrorKind::Input, name + ": " + cause); };
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) fail("not a sound WebP file");
  if (features.has_animation != 0) fail("is an animated WebP, expected a still one");
  const auto pixels = static_cast<std::uint64_t>(features.width) * static_cast<std::uint64_t>(features.height);
  if (pixels > max_pixels)
    fail("has " + std::to_string(pixels) + " pixels, the limit is " + std::to_string(max_pixels) + " (--max-pixels)");
  // A small file can be a valid image of one colour. If it claims many pixels, libwebp first decodes it into its own
  // buffer, of which only the written pages take memory, so that a corrupt file takes none.
  constexpr std::uint64_t max_per_byte = 256;
  check_deadline();
  if (pixels / max_per_byte > bytes.size()) {
    int2 size;
    const std::unique_ptr<std::uint8_t, decltype(&WebPFree)> decoded(
        WebPDecodeRGBA(bytes.data(), bytes.size(), &size.x, &size.y), &WebPFree);
    if (!decoded) fail("the WebP file is corrupt or cut off");
  }
  check_deadline();
  Rgba8Image image(features.width, features.height);
  static_assert(sizeof(Rgba8) == 4, "libwebp writes rows as they lie");
  auto* const out = reinterpret_cast<std::uint8_t*>(image.values().data());
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), out, image.values().size() * 4, 4 * image.width()) == nullptr)
    fail("the WebP file is corrupt or cut off");
  return image;
}

namespace {

/// The file with a chunk of the profile.
std::vector<std::uint8_t> with_profile(const std::vector<std::uint8_t>& file, std::span<const std::uint8_t> icc) {
  const WebPData image{file.data(), file.size()}, chunk{icc.data(), icc.size()};
  const std::unique_ptr<WebPMux, decltype(&WebPMuxDelete)> mux(WebPMuxCreate(&image, 0), &WebPMuxDelete);
  WebPData assembled;
  WebPDataInit(&assembled);
  const bool is_done = mux && WebPMuxSetChunk(mux.get(), "ICCP", &chunk, 0) == WEBP_MUX_OK &&
                       WebPMuxAssemble(mux.get(), &assembled) == WEBP_MUX_OK;
  std::vector<std::uint8_t> out;
  if (is_done) out.assign(assembled.bytes, assembled.bytes + assembled.size);
  WebPDataClear(&assembled);
  if (!is_done) throw Error(ErrorKind::Failed, "an ICC profile cannot be written to a WebP file");
  return out;
}

}  // namespace

std::vector<std::uint8_t> encode_webp(const Rgba8Image& image, bool has_alpha, std::optional<int> quality,
                                      std::span<const std::uint8_t> icc) {
  WebPConfig config;
  WebPPicture picture;
  if (WebPConfigInit(&config) == 0 || WebPPictureInit(&picture) == 0)
    throw Error(ErrorKind::Failed, "libwebp has another version than its headers");
  if (quality) {
    config.quality = static_cast<float>(*quality);
    config.use_sharp_yuv = 1;  // less colour bleeding at edges
  } else {
    config.lossless = 1;
    config.exact = 1;     // keeps the colours of transparent pixels, because filters blend them
    config.quality = 70;  // the effort, the same as in libwebp's simple API
  }

  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.use_argb = 1;
  picture.width = image.width(), picture.height = image.height();
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  const auto* const pixels = reinterpret_cast<const std::uint8_t*>(image.values().data());
  const auto import = has_alpha ? WebPPictureImportRGBA : WebPPictureImportRGBX;
  const bool is_done = import(&picture, pixels, 4 * image.width()) != 0 && WebPEncode(&config, &picture) != 0;
  std::vector<std::uint8_t> out;
  if (is_done) out.assign(writer.mem, writer.mem + writer.size);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  if (!is_done)
    throw Error(ErrorKind::Failed, "an image of " + std::to_string(image.width()) + " x " +
                                       std::to_string(image.height()) + " pixels cannot be encoded as WebP");
  return icc.empty() ? out : with_profile(out, icc);
}

}  // namespace zoneplate
