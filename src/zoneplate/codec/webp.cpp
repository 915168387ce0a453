// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/webp.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cassert>
#include <memory>
#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr float effort = 60;  // of 100, for lossless files: more effort takes longer and hardly shrinks the file
constexpr int method = 4;     // of 6, the same compromise

[[noreturn]] void fail(const std::string& reason) {
  throw Error(ErrorKind::Failed, "an animation cannot be encoded as WebP: " + reason);
}

struct Close {
  void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
};
using Encoder = std::unique_ptr<WebPAnimEncoder, Close>;

/// Owns a WebPPicture.
class Picture {
 public:
  Picture(const Rgba8Image& image, bool has_alpha) {
    if (WebPPictureInit(&picture_) == 0) fail("libwebp has another version than its headers");
    picture_.use_argb = 1;
    picture_.width = image.width(), picture_.height = image.height();
    static_assert(sizeof(Rgba8) == 4, "rows are handed to libwebp as they lie");
    const auto* pixels = reinterpret_cast<const std::uint8_t*>(image.values().data());
    const auto import = has_alpha ? WebPPictureImportRGBA : WebPPictureImportRGBX;
    if (import(&picture_, pixels, 4 * image.width()) == 0)
      fail("a frame of " + std::to_string(image.width()) + " x " + std::to_string(image.height()) + " pixels");
  }
  ~Picture() { WebPPictureFree(&picture_); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  WebPPicture* operator*() { return &picture_; }

 private:
  WebPPicture picture_;
};

struct Data {
  Data() { WebPDataInit(&data); }
  ~Data() { WebPDataClear(&data); }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  WebPData data;
};

WebPConfig lossless() {
  WebPConfig config;
  if (WebPConfigInit(&config) == 0) fail("libwebp has another version than its headers");
  config.lossless = 1;
  config.exact = 1;
  config.quality = effort;
  config.method = method;
  return config;
}

Encoder make_encoder(const Animation& animation) {
  WebPAnimEncoderOptions options;
  if (WebPAnimEncoderOptionsInit(&options) == 0) fail("libwebpmux has another version than its headers");
  options.anim_params.loop_count = animation.loops;
  Encoder encoder(WebPAnimEncoderNew(animation.frames[0].width(), animation.frames[0].height(), &options));
  if (!encoder) fail("frames of this size are not possible");
  return encoder;
}

}  // namespace

std::vector<std::uint8_t> encode_webp(const Animation& animation) {
  assert(!animation.frames.empty());
  const WebPConfig config = lossless();
  const Encoder encoder = make_encoder(animation);
  const auto begins = [&](std::size_t i) {
    return static_cast<int>(
        (2000 * i * static_cast<std::size_t>(animation.seconds) / static_cast<std::size_t>(animation.per) + 1) / 2);
  };
  for (std::size_t i = 0; i < animation.frames.size(); ++i) {
    Picture picture(animation.frames[i], animation.has_alpha);
    if (WebPAnimEncoderAdd(encoder.get(), *picture, begins(i), &config) == 0)
      fail(WebPAnimEncoderGetError(encoder.get()));
  }
  Data data;
  if (WebPAnimEncoderAdd(encoder.get(), nullptr, begins(animation.frames.size()), nullptr) == 0 ||
      WebPAnimEncoderAssemble(encoder.get(), &data.data) == 0)
    fail(WebPAnimEncoderGetError(encoder.get()));
  return {data.data.bytes, data.data.bytes + data.data.size};
}

}  // namespace zoneplate
