// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/webp.h"

#include <gtest/gtest.h>
#include <webp/demux.h>

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
