// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/apng_reader.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct FrameForTest {
  int x = 0, y = 0;
  Bytes png;  ///< of the part
  int seconds = 1, per = 10, disposal = 0, blend = 0;
};

/// An APNG of parts that are PNG files of one kind; `is_still` puts an image before the frames that is none of them.
Bytes apng_of(const std::vector<FrameForTest>& frames, int width, int height, const Bytes& still = {}) {
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  std::uint32_t sequence = 0;
  const auto data_of = [](const Bytes& png, std::string_view wanted) {
    Bytes found;
    for_png_chunks(png, [&](std::string_view name, std::span<const std::uint8_t> data) {
      if (name == wanted) found.insert(found.end(), data.begin(), data.end());
      return true;
    });
    return found;
  };
  Bytes header = data_of(frames[0].png, "IHDR"), counts;
  Bytes size;
  put_png_word(size, static_cast<std::uint32_t>(width)), put_png_word(size, static_cast<std::uint32_t>(height));
  std::copy(size.begin(), size.end(), header.begin());
  put_png_chunk(out, "IHDR", header);
  put_png_word(counts, static_cast<std::uint32_t>(frames.size())), put_png_word(counts, 3);
  put_png_chunk(out, "acTL", counts);
  if (!still.empty()) put_png_chunk(out, "IDAT", data_of(still, "IDAT"));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameForTest& f = frames[i];
    const Bytes own = data_of(f.png, "IHDR");
    Bytes control;
    put_png_word(control, sequence++);
    control.insert(control.end(), own.begin(), own.begin() + 8);
    put_png_word(control, static_cast<std::uint32_t>(f.x)), put_png_word(control, static_cast<std::uint32_t>(f.y));
    for (const int v : {f.seconds, f.per})
      control.insert(control.end(), {static_cast<std::uint8_t>(v >> 8), static_cast<std::uint8_t>(v)});
    control.insert(control.end(), {static_cast<std::uint8_t>(f.disposal), static_cast<std::uint8_t>(f.blend)});
    put_png_chunk(out, "fcTL", control);
    const Bytes data = data_of(f.png, "IDAT");
    if (i == 0 && still.empty()) {
      put_png_chunk(out, "IDAT", data);
      continue;
    }
    Bytes numbered;
    put_png_word(numbered, sequence++);
    numbered.insert(numbered.end(), data.begin(), data.end());
    put_png_chunk(out, "fdAT", numbered);
  }
  put_png_chunk(out, "IEND", {});
  return out;
}

const std::string file_name = "a.png";

std::vector<AnimationFrame> frames_of(const Bytes& file) {
  const auto reader = open_apng(file, file_name, 1 << 20);
  std::vector<AnimationFrame> frames;
  for (std::size_t i = 0; i < reader->info().frames; ++i) frames.push_back(reader->next());
  return frames;
}
std::string error_of(const Bytes& file) {
  try {
    frames_of(file);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

template <class Pixel>
std::vector<Pixel> pixels_of(const AnimationFrame& frame) {
  const auto values = frame.image.as<Pixel>().values();
  return {values.begin(), values.end()};
}

constexpr Rgba8 red{255, 0, 0, 255}, blue{0, 0, 255, 255}, none{0, 0, 0, 0};

TEST(ApngReader, ReadsWhatTheEncoderWrites) {
  Animation animation{.format = {.seconds = 1, .per = 24, .loops = 7, .has_alpha = true}, .frames = {}};
  for (int i = 0; i < 4; ++i) {
    Rgba8Image& frame = animation.frames.emplace_back(9, 5, Rgba8{1, 2, 3, 200});
    frame(2 * i, 1) = {255, 9, 9, static_cast<std::uint8_t>(60 * i)};
  }
  const std::vector<AnimationFrame> frames = frames_of(encode_apng(animation));
  ASSERT_EQ(frames.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].image.as<Rgba8>(), animation.frames[i]);
    EXPECT_EQ(frames[i].time, (FrameTime{1, 24}));
  }
  EXPECT_EQ(open_apng(encode_apng(animation), file_name, 45)->info().loops, 7);
  EXPECT_EQ(error_of(encode_png(animation.frames[0])), "a.png: APNG: has no frames");
}

TEST(ApngReader, FramesHaveTimesOfTheirOwn) {
  const auto encoder = make_apng_encoder({.seconds = 1, .per = 7});
  const auto frame = std::make_shared<const Rgba8Image>(2, 2, red),
             other = std::make_shared<const Rgba8Image>(2, 2, blue);
  encoder->add(frame, FrameTime{3, 50})();
  encoder->add(other)();
  const std::vector<AnimationFrame> frames = frames_of(encoder->finish());
  EXPECT_EQ(frames[0].time, (FrameTime{3, 50}));
  EXPECT_EQ(frames[1].time, (FrameTime{1, 7}));
}

TEST(ApngReader, FramesAreDisposedOfAndBlended) {
  const auto part = [](int width, int height, Rgba8 color) { return encode_png(Rgba8Image(width, height, color)); };
  const Rgba8 half_blue{0, 0, 255, 128};
  const std::vector<AnimationFrame> frames =
      frames_of(apng_of({{.png = part(2, 1, red)},
                         {.png = part(1, 1, half_blue), .per = 0, .disposal = 2, .blend = 1},
                         {.x = 1, .png = part(1, 1, half_blue), .disposal = 1},
                         {.png = part(1, 1, half_blue), .blend = 1},
                         {.x = 1, .png = part(1, 1, half_blue), .blend = 1}},
                        2, 1));
  ASSERT_EQ(frames.size(), 5u);
  // 128 / 255 of blue over red, and nothing of red behind transparent.
  const Rgba8 mixed{127, 0, 128, 255};
  EXPECT_EQ(pixels_of<Rgba8>(frames[0]), (std::vector{red, red}));
  EXPECT_EQ(pixels_of<Rgba8>(frames[1]), (std::vector{mixed, red}));
  EXPECT_EQ(pixels_of<Rgba8>(frames[2]), (std::vector{red, half_blue}));
  EXPECT_EQ(pixels_of<Rgba8>(frames[3]), (std::vector{mixed, none}));
  EXPECT_EQ(pixels_of<Rgba8>(frames[4]), (std::vector{mixed, half_blue}));
  EXPECT_EQ(frames[1].time, (FrameTime{1, 100}));
}

TEST(ApngReader, AStillImageBeforeTheFramesIsNone) {
  const std::vector<AnimationFrame> frames =
      frames_of(apng_of({{.png = encode_png(Rgba8Image(1, 1, red)), .disposal = 2},
                         {.png = encode_png(Rgba8Image(1, 1, {0, 0, 255, 0})), .blend = 1}},
                        1, 1, encode_png(Rgba8Image(1, 1, {9, 9, 9, 255}))));
  EXPECT_EQ(pixels_of<Rgba8>(frames[0]), (std::vector{red}));
  EXPECT_EQ(pixels_of<Rgba8>(frames[1]), (std::vector{none}));  // nothing was there before the first frame
}

TEST(ApngReader, SixteenBitsStay) {
  const Rgba16 deep{257, 1000, 65535, 30000};
  const std::vector<AnimationFrame> frames =
      frames_of(apng_of({{.png = encode_png(Rgba16Image(1, 1, deep))},
                         {.png = encode_png(Rgba16Image(1, 1, {0, 0, 0, 32768})), .blend = 1}},
                        1, 1));
  EXPECT_EQ(pixels_of<Rgba16>(frames[0]), (std::vector{deep}));
  // Alpha 32768 over 30000; the colours by the weights 32768 · 65535 of black and 30000 · 32767.
  EXPECT_EQ(pixels_of<Rgba16>(frames[1]), (std::vector{Rgba16{81, 314, 20579, 47768}}));
}

TEST(ApngReader, DamageIsAnError) {
  const Bytes red_png = encode_png(Rgba8Image(2, 2, red)), small = encode_png(Rgba8Image(1, 1, red));
  const Bytes file = apng_of({{.png = red_png}, {.x = 1, .y = 1, .png = small}}, 2, 2);
  EXPECT_EQ(error_of(file), "");
  EXPECT_EQ(error_of(apng_of({{.png = red_png}, {.x = 2, .png = small}}, 2, 2)),
            "a.png: APNG: a frame lies outside of the image");
  EXPECT_EQ(error_of(apng_of({{.png = small}, {.png = small}}, 2, 2)),
            "a.png: APNG: its first frame is not the whole image");
  EXPECT_EQ(error_of(apng_of({{.png = red_png}, {.png = small, .disposal = 3}}, 2, 2)),
            "a.png: APNG: a frame is disposed of or blended in an unknown way");
  EXPECT_EQ(error_of(apng_of({{.png = small}, {.png = small}}, 60000, 60000)),
            "a.png: APNG: 60000 x 60000 pixels, at most 1048576 are allowed");
  for (std::size_t size = 8; size < file.size(); ++size)
    EXPECT_NE(error_of({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Bytes changed = file;
    changed[8 + hash(i) % (changed.size() - 8)] ^= static_cast<std::uint8_t>(1 + hash(i + 1000) % 255);
    const std::string error = error_of(changed);  // a checksum is wrong, at least
    EXPECT_NE(error, "") << i;
    EXPECT_EQ(error.find('\n'), std::string::npos) << i;
  }
}

TEST(FrameTimes, AreTheNearestFractions) {
  EXPECT_EQ(FrameTime::of_milliseconds(100), (FrameTime{1, 10}));
  EXPECT_EQ(FrameTime::of_milliseconds(33), (FrameTime{33, 1000}));
  EXPECT_EQ(FrameTime::of_microseconds(33333), (FrameTime{1, 30}));
  EXPECT_EQ(FrameTime::of_microseconds(41667), (FrameTime{1, 24}));
  EXPECT_EQ(FrameTime::of_milliseconds(0), (FrameTime{0, 1}));
  EXPECT_EQ(FrameTime::of_milliseconds(-5), (FrameTime{0, 1}));
  EXPECT_EQ(FrameTime::of_milliseconds(70'000'000), (FrameTime{65535, 1}));
}

}  // namespace
}  // namespace zoneplate
