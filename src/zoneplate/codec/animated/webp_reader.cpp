// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/webp_reader.h"

#include <fmt/format.h>
#include <webp/decode.h>
#include <webp/demux.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/bitmap/bytes.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

using View = std::span<const std::uint8_t>;

struct Close {
  void operator()(WebPAnimDecoder* decoder) const { WebPAnimDecoderDelete(decoder); }
};

class WebpReader final : public AnimationReader {
 public:
  WebpReader(View bytes, const std::string& name, std::uint64_t max_pixels) : name_(name) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) fail("is no sound WebP");
    const auto pixels = static_cast<std::uint64_t>(features.width) * static_cast<std::uint64_t>(features.height);
    if (pixels > max_pixels)
      fail(fmt::format("{} x {} pixels, at most {} are allowed", features.width, features.height, max_pixels));
    WebPAnimDecoderOptions options;
    if (WebPAnimDecoderOptionsInit(&options) == 0) fail("libwebpdemux has another version than its headers");
    options.color_mode = MODE_RGBA;
    const WebPData data{bytes.data(), bytes.size()};
    decoder_.reset(WebPAnimDecoderNew(&data, &options));
    WebPAnimInfo info;
    if (!decoder_ || WebPAnimDecoderGetInfo(decoder_.get(), &info) == 0 || info.frame_count == 0)
      fail("is corrupt or truncated");
    info_ = {{static_cast<int>(info.canvas_width), static_cast<int>(info.canvas_height)},
             info.frame_count,
             static_cast<int>(std::min(info.loop_count, 65535u))};
  }

  const AnimationInfo& info() const override { return info_; }

  AnimationFrame next() override {
    check_deadline();
    ++done_;
    std::uint8_t* pixels = nullptr;
    int end = 0;
    if (WebPAnimDecoderGetNext(decoder_.get(), &pixels, &end) == 0) fail(fmt::format("frame {} is corrupt", done_));
    Rgba8Image image(info_.size.x, info_.size.y);
    static_assert(sizeof(Rgba8) == 4, "libwebp writes rows as they lie");
    std::copy_n(pixels, image.values().size() * 4, reinterpret_cast<std::uint8_t*>(image.values().data()));
    return {std::move(image), FrameTime::of_milliseconds(end - std::exchange(end_, end))};
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, name_ + ": WebP animation: " + cause);
  }

  const std::string name_;
  std::unique_ptr<WebPAnimDecoder, Close> decoder_;
  AnimationInfo info_;
  int end_ = 0;  ///< of the frame before, in milliseconds
  std::size_t done_ = 0;
};

}  // namespace

bool is_animated_webp(View bytes) {
  constexpr std::uint8_t is_animated = 0x02;
  constexpr std::string_view name = "VP8X";
  return is_webp(bytes) && bytes.size() >= 21 && std::equal(name.begin(), name.end(), bytes.begin() + 12) &&
         (bytes[20] & is_animated) != 0;
}

std::size_t count_webp_frames(View bytes) {
  std::size_t frames = 0;
  if (!is_webp(bytes)) return frames;
  for (std::size_t at = 12; bytes.size() - at >= 8;) {
    const std::size_t size = little_endian(bytes, at + 4, 4);
    if (bytes.size() - at - 8 < size) break;
    frames += std::string_view(reinterpret_cast<const char*>(bytes.data()) + at, 4) == "ANMF";
    at += std::min(8 + size + size % 2, bytes.size() - at);
  }
  return frames;
}

std::unique_ptr<AnimationReader> open_webp_animation(View bytes, const std::string& name, std::uint64_t max_pixels) {
  return std::make_unique<WebpReader>(bytes, name, max_pixels);
}

Rgba8Image decode_first_webp_frame(View bytes, const std::string& name, std::uint64_t max_pixels) {
  return WebpReader(bytes, name, max_pixels).next().image.as<Rgba8>();
}

}  // namespace zoneplate
