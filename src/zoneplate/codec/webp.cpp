// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/webp.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>
#include <queue>
#include <string>
#include <utility>

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

WebPConfig config_of(std::optional<int> quality) {
  WebPConfig config;
  if (WebPConfigInit(&config) == 0) fail("libwebp has another version than its headers");
  config.method = method;
  if (quality) {
    config.quality = static_cast<float>(*quality);
    config.use_sharp_yuv = 1;  // less colour bleeding at edges
  } else {
    config.lossless = 1;
    config.exact = 1;
    config.quality = effort;
  }
  return config;
}

Encoder make_encoder(const Rgba8Image& first, int loops) {
  WebPAnimEncoderOptions options;
  if (WebPAnimEncoderOptionsInit(&options) == 0) fail("libwebpmux has another version than its headers");
  options.anim_params.loop_count = loops;
  Encoder encoder(WebPAnimEncoderNew(first.width(), first.height(), &options));
  if (!encoder) fail("frames of this size are not possible");
  return encoder;
}

/// libwebp compares each frame with the one before. The frames therefore wait in a queue, and each work encodes the
/// first one in it.
class WebpEncoder final : public AnimationEncoder {
 public:
  WebpEncoder(const AnimationFormat& format, std::optional<int> quality)
      : format_(format), config_(config_of(quality)) {}

  std::function<void()> add(std::shared_ptr<const Rgba8Image> frame, std::optional<FrameTime> time) override {
    const std::lock_guard lock(mutex_);
    waiting_.push({std::move(frame), end_});
    if (time)
      timed_ += static_cast<double>(time->seconds) / time->per;
    else
      ++untimed_;
    end_ = static_cast<int>(std::lround(1000 * timed_)) + begin_of(untimed_);
    return [this] { encode_first(); };
  }

  std::vector<std::uint8_t> finish() override {
    assert(encoder_ && waiting_.empty());
    Data data;
    if (WebPAnimEncoderAdd(encoder_.get(), nullptr, end_, nullptr) == 0 ||
        WebPAnimEncoderAssemble(encoder_.get(), &data.data) == 0)
      fail(WebPAnimEncoderGetError(encoder_.get()));
    return {data.data.bytes, data.data.bytes + data.data.size};
  }

 private:
  struct Waiting {
    std::shared_ptr<const Rgba8Image> frame;
    int begin = 0;  ///< in milliseconds
  };

  void encode_first() {
    const std::lock_guard order(encoding_);
    const Waiting first = take_first();
    if (!encoder_) encoder_ = make_encoder(*first.frame, format_.loops);
    Picture picture(*first.frame, format_.has_alpha);
    if (WebPAnimEncoderAdd(encoder_.get(), *picture, first.begin, &config_) == 0)
      fail(WebPAnimEncoderGetError(encoder_.get()));
  }

  Waiting take_first() {
    const std::lock_guard lock(mutex_);
    Waiting first = std::move(waiting_.front());
    waiting_.pop();
    return first;
  }

  /// The time in milliseconds at which frame `i` begins, of frames without times of their own.
  int begin_of(std::size_t i) const {
    return static_cast<int>(
        (2000 * i * static_cast<std::size_t>(format_.seconds) / static_cast<std::size_t>(format_.per) + 1) / 2);
  }

  const AnimationFormat format_;
  const WebPConfig config_;
  std::mutex mutex_;  ///< of the queue and the times
  std::queue<Waiting> waiting_;
  double timed_ = 0;  ///< seconds of the frames with times of their own
  std::size_t untimed_ = 0;
  int end_ = 0;          ///< of all frames, in milliseconds
  std::mutex encoding_;  ///< of the encoder
  Encoder encoder_;
};

}  // namespace

std::unique_ptr<AnimationEncoder> make_webp_encoder(const AnimationFormat& format, std::optional<int> quality) {
  return std::make_unique<WebpEncoder>(format, quality);
}

std::vector<std::uint8_t> encode_webp(const Animation& animation, std::optional<int> quality) {
  WebpEncoder encoder(animation.format, quality);
  return encode_animation(encoder, animation);
}

}  // namespace zoneplate
