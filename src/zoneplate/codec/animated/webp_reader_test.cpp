// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/webp_reader.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/webp.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::string file_name = "a.webp";

Animation noise() {
  Animation animation{.format = {.seconds = 1, .per = 24, .loops = 5, .has_alpha = true}, .frames = {}};
  for (std::uint32_t i = 0; i < 4; ++i)
    for (Rgba8& c : animation.frames.emplace_back(13, 11).values()) {
      const std::uint32_t word = hash(static_cast<std::uint32_t>(&c - animation.frames.back().values().data()), i);
      c = {static_cast<std::uint8_t>(word >> 24), static_cast<std::uint8_t>(word >> 16), 5,
           static_cast<std::uint8_t>(word % 2 == 0 ? 255 : 128)};
    }
  return animation;
}

std::string error_of(const Bytes& file, std::uint64_t max_pixels = 1 << 20) {
  try {
    const auto reader = open_webp_animation(file, file_name, max_pixels);
    for (std::size_t i = 0; i < reader->info().frames; ++i) reader->next();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(WebpReader, ReadsWhatTheEncoderWrites) {
  const Animation animation = noise();
  const Bytes file = encode_webp(animation);
  const auto reader = open_webp_animation(file, file_name, 143);
  ASSERT_EQ(reader->info().frames, 4u);
  EXPECT_EQ(reader->info().loops, 5);
  const int milliseconds[] = {42, 41, 42, 42};
  for (std::size_t i = 0; i < 4; ++i) {
    const AnimationFrame frame = reader->next();
    EXPECT_EQ(frame.image.as<Rgba8>(), animation.frames[i]);
    EXPECT_EQ(frame.time, FrameTime::of_milliseconds(milliseconds[i]));
  }
  EXPECT_EQ(count_webp_frames(file), 4u);
  EXPECT_TRUE(is_animated_webp(file));
  EXPECT_FALSE(is_animated_webp(encode_webp(animation.frames[0], true)));
  EXPECT_EQ(decode_first_webp_frame(file, file_name, 143), animation.frames[0]);
  EXPECT_EQ(error_of(file, 142), "a.webp: WebP animation: 13 x 11 pixels, at most 142 are allowed");
}

TEST(WebpReader, FramesHaveTimesOfTheirOwn) {
  const Animation animation = noise();
  const auto encoder = make_webp_encoder(animation.format);
  const FrameTime times[] = {{1, 3}, {1, 100}, {2, 100}, {1, 3}};
  for (std::size_t i = 0; i < 4; ++i) encoder->add(std::make_shared<const Rgba8Image>(animation.frames[i]), times[i])();
  const Bytes file = encoder->finish();
  const auto reader = open_webp_animation(file, file_name, 143);
  ASSERT_EQ(reader->info().frames, 4u);
  for (const int time : {333, 10, 20, 334}) EXPECT_EQ(reader->next().time, FrameTime::of_milliseconds(time));
}

TEST(WebpReader, DamageIsAnError) {
  const Bytes file = encode_webp(noise());
  for (std::size_t size = 0; size < file.size(); size += 7)
    EXPECT_NE(error_of({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Bytes changed = file;
    for (std::uint32_t k = 0; k < 3; ++k)
      changed[12 + hash(i, k) % (changed.size() - 12)] = static_cast<std::uint8_t>(hash(i, k + 10));
    count_webp_frames(changed);
    EXPECT_EQ(error_of(changed).find('\n'), std::string::npos) << i;
  }
}

}  // namespace
}  // namespace zoneplate
