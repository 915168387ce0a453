// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/webp.h"

#include <gtest/gtest.h>
#include <webp/demux.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

Animation noise(bool has_alpha) {
  Animation animation{.format = {.seconds = 1, .per = 24, .loops = 5, .has_alpha = has_alpha}, .frames = {}};
  std::uint32_t word = 1;
  for (int i = 0; i < 4; ++i)
    for (Rgba8& c : animation.frames.emplace_back(33, 21).values()) {
      word = word * 1664525u + 1013904223u;
      c = {static_cast<std::uint8_t>(word >> 24), static_cast<std::uint8_t>(word >> 16), 5, 255};
      if (has_alpha) c.a = word >> 31 ? 255 : 128;
    }
  return animation;
}

struct Close {
  void operator()(WebPAnimDecoder* decoder) const { WebPAnimDecoderDelete(decoder); }
};

/// The frames that a player displays, and the end times of the frames.
struct Played {
  std::vector<Rgba8Image> frames;
  std::vector<int> ends;
  std::uint32_t loops = 0;
};
Played played(const std::vector<std::uint8_t>& file) {
  const WebPData data{file.data(), file.size()};
  const std::unique_ptr<WebPAnimDecoder, Close> decoder(WebPAnimDecoderNew(&data, nullptr));
  EXPECT_TRUE(decoder);
  WebPAnimInfo info{};
  WebPAnimDecoderGetInfo(decoder.get(), &info);
  Played result{.loops = info.loop_count};
  std::uint8_t* pixels = nullptr;
  for (int end = 0; WebPAnimDecoderGetNext(decoder.get(), &pixels, &end) != 0;) {
    Rgba8Image& frame =
        result.frames.emplace_back(static_cast<int>(info.canvas_width), static_cast<int>(info.canvas_height));
    std::memcpy(static_cast<void*>(frame.values().data()), pixels, frame.values().size_bytes());
    result.ends.push_back(end);
  }
  return result;
}

TEST(Webp, PlaysTheFramesThatWereGiven) {
  for (const bool has_alpha : {false, true}) {
    const Animation animation = noise(has_alpha);
    const auto file = encode_webp(animation);
    const Played result = played(file);
    EXPECT_EQ(result.frames, animation.frames);
    EXPECT_EQ(result.ends, (std::vector<int>{42, 83, 125, 167}));
    EXPECT_EQ(result.loops, 5u);
    EXPECT_EQ(encode_webp(animation), file);
  }
}

// A disc that moves over a gradient: what a film of a model looks like.
TEST(Webp, AQualityMakesAnimationsSmallerAndKeepsAlpha) {
  Animation animation{.format = {.seconds = 1, .per = 24, .has_alpha = true}, .frames = {}};
  for (int i = 0; i < 6; ++i) {
    Rgba8Image& frame = animation.frames.emplace_back(96, 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 96; ++x) {
        const int dx = x - 20 - 8 * i, dy = y - 32;
        const bool is_disc = dx * dx + dy * dy < 300;
        frame(x, y) = {static_cast<std::uint8_t>(is_disc ? 200 - 2 * y : 2 * x), static_cast<std::uint8_t>(90 + y),
                       static_cast<std::uint8_t>(40 + (x * x + 3 * y * y) % 23),
                       static_cast<std::uint8_t>(x < 8 ? 0 : 255)};
      }
  }
  const auto lossless = encode_webp(animation), good = encode_webp(animation, 90), poor = encode_webp(animation, 20);
  EXPECT_LT(good.size(), lossless.size());
  EXPECT_LT(poor.size(), good.size() / 2);
  EXPECT_EQ(encode_webp(animation, 90), good);
  const auto error_of = [&](const std::vector<std::uint8_t>& file) {
    const Played shown = played(file);
    EXPECT_EQ(shown.ends, played(lossless).ends);
    double sum = 0;
    for (std::size_t i = 0; i < shown.frames.size(); ++i)
      for (std::size_t p = 0; p < shown.frames[i].values().size(); ++p) {
        const Rgba8 &a = shown.frames[i].values()[p], &b = animation.frames[i].values()[p];
        EXPECT_EQ(a.a, b.a);
        if (b.a > 0) sum += (a.r - b.r) * (a.r - b.r) + (a.g - b.g) * (a.g - b.g) + (a.b - b.b) * (a.b - b.b);
      }
    return std::sqrt(sum / (3.0 * 6 * 96 * 64));
  };
  EXPECT_LT(error_of(good), 8);
  EXPECT_GT(error_of(poor), error_of(good));
}

TEST(Webp, TheOrderOfTheWorkDoesNotMatter) {
  const Animation animation = noise(true);
  const auto encoder = make_webp_encoder(animation.format);
  std::vector<std::function<void()>> works;
  for (const Rgba8Image& frame : animation.frames)
    works.push_back(encoder->add(std::make_shared<const Rgba8Image>(frame)));
  for (auto work = works.rbegin(); work != works.rend(); ++work) (*work)();
  EXPECT_EQ(encoder->finish(), encode_webp(animation));
}

TEST(Webp, RefusesWhatTheFormatCannotHold) {
  Animation wide;
  wide.frames.emplace_back(16384, 1);
  try {
    encode_webp(wide);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Failed);
  }
}

}  // namespace
}  // namespace zoneplate
