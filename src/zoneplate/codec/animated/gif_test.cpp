// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/gif.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/gif_file_for_test.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Rgba8 black{0, 0, 0, 255}, red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255}, none{0, 0, 0, 0};
const Bytes four_colors = {0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255};

std::vector<AnimationFrame> frames_of(const Bytes& file) {
  const std::string name = "a.gif";
  const auto reader = open_gif(file, name, 1 << 20);
  std::vector<AnimationFrame> frames;
  for (std::size_t i = 0; i < reader->info().frames; ++i) frames.push_back(reader->next());
  return frames;
}
std::vector<Rgba8> pixels_of(const AnimationFrame& frame) {
  const auto values = frame.image.as<Rgba8>().values();
  return {values.begin(), values.end()};
}
std::string error_of(const Bytes& file, std::uint64_t max_pixels = 1 << 20) {
  try {
    const std::string name = "a.gif";
    const auto reader = open_gif(file, name, max_pixels);
    for (std::size_t i = 0; i < reader->info().frames; ++i) reader->next();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Gif, FramesAreDisposedOfAsTheyState) {
  // Two by two: red, then a blue pixel that is cleared, a green one that is undone, and one that is nowhere
  // transparent.
  GifMaker maker(2, 2, four_colors, 4);
  maker.frame({.width = 2, .height = 2, .indices = {1, 1, 1, 1}, .delay = 10})
      .frame({.x = 1, .width = 1, .height = 1, .indices = {3}, .delay = 3, .disposal = 2})
      .frame({.y = 1, .width = 2, .height = 1, .indices = {2, 0}, .delay = 7, .disposal = 3, .transparent = 0})
      .frame({.x = 1, .y = 1, .width = 1, .height = 1, .indices = {0}, .delay = 0});
  const std::vector<AnimationFrame> frames = frames_of(maker.end());
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(pixels_of(frames[0]), (std::vector{red, red, red, red}));
  EXPECT_EQ(pixels_of(frames[1]), (std::vector{red, blue, red, red}));
  EXPECT_EQ(pixels_of(frames[2]), (std::vector{red, none, green, red}));
  EXPECT_EQ(pixels_of(frames[3]), (std::vector{red, none, red, black}));
  EXPECT_EQ(frames[0].time, (FrameTime{10, 100}));
  EXPECT_EQ(frames[3].time, (FrameTime{0, 100}));
  const std::string name = "a.gif";
  const Bytes file = maker.end();
  EXPECT_EQ(open_gif(file, name, 4)->info().loops, 5);
  EXPECT_TRUE(open_gif(file, name, 4)->info().has_alpha);
  EXPECT_EQ(count_gif_frames(file), 4u);
  EXPECT_EQ(decode_gif(file, name, 4), frames[0].image.as<Rgba8>());
}

TEST(Gif, FramesHaveTheirOwnColoursAndLieAnywhere) {
  GifMaker maker(3, 1, {});
  maker.frame({.x = 2, .width = 2, .height = 3, .indices = Bytes(6, 1), .colors = {9, 9, 9, 0, 0, 255}});
  const std::vector<AnimationFrame> frames = frames_of(maker.end());
  EXPECT_EQ(pixels_of(frames[0]), (std::vector{none, none, blue}));
  // A screen without a size has that of the first frame.
  GifMaker empty(0, 0, four_colors);
  empty.frame({.width = 2, .height = 1, .indices = {1, 2}});
  EXPECT_EQ(pixels_of(frames_of(empty.end())[0]), (std::vector{red, green}));
  EXPECT_EQ(find_gif_size(empty.end())->x, 2);
  EXPECT_FALSE(open_gif(empty.end(), "", 9)->info().has_alpha);
  EXPECT_EQ(open_gif(empty.end(), "", 9)->info().loops, 1);
}

TEST(Gif, RowsMayBeInterlaced) {
  for (const int height : {1, 2, 3, 5, 8, 9, 17}) {
    Bytes stored;
    for (const auto& [first, step] : {std::pair(0, 8), std::pair(4, 8), std::pair(2, 4), std::pair(1, 2)})
      for (int y = first; y < height; y += step) stored.push_back(static_cast<std::uint8_t>(y % 4));
    GifMaker maker(1, height, four_colors);
    maker.frame({.width = 1, .height = height, .indices = stored, .is_interlaced = true});
    const std::vector<AnimationFrame> frames = frames_of(maker.end());
    const Rgba8 colors[] = {black, red, green, blue};
    for (int y = 0; y < height; ++y) EXPECT_EQ(frames[0].image.as<Rgba8>()(0, y), colors[y % 4]) << height << " " << y;
  }
}

TEST(Gif, CodesGrowToTwelveBitsAndBeginAgain) {
  Bytes colors(3 * 256);
  for (std::size_t i = 0; i < 256; ++i) colors[3 * i] = static_cast<std::uint8_t>(i);
  // Noise fills the table several times; runs use the code that is being added.
  for (const bool is_noise : {true, false}) {
    Bytes indices(150 * 150);
    for (std::size_t i = 0; i < indices.size(); ++i)
      indices[i] = is_noise ? static_cast<std::uint8_t>(hash(static_cast<std::uint32_t>(i))) : std::uint8_t{7};
    GifMaker maker(150, 150, colors);
    maker.frame({.width = 150, .height = 150, .indices = indices}, 8);
    const Rgba8Image image = frames_of(maker.end())[0].image.as<Rgba8>();
    for (std::size_t i = 0; i < indices.size(); ++i) ASSERT_EQ(image.values()[i].r, indices[i]) << i;
  }
}

TEST(Gif, SizesAreCheckedFirst) {
  GifMaker maker(60000, 60000, four_colors);
  maker.frame({.width = 1, .height = 1, .indices = {1}});
  EXPECT_EQ(error_of(maker.end()), "a.gif: GIF: 60000 x 60000 pixels, at most 1048576 are allowed");
  GifMaker part(1, 1, four_colors);
  part.frame({.width = 60000, .height = 60000, .indices = {1}});
  EXPECT_EQ(error_of(part.end()), "a.gif: GIF: 60000 x 60000 pixels, at most 1048576 are allowed");
}

TEST(Gif, DamageIsAnError) {
  GifMaker maker(2, 2, four_colors);
  maker.frame({.width = 2, .height = 2, .indices = {1, 2, 3, 0}});
  const Bytes file = maker.end();
  EXPECT_EQ(error_of(file), "");
  for (std::size_t size = 0; size + 1 < file.size(); ++size)
    EXPECT_NE(error_of({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  EXPECT_EQ(error_of({file.begin(), file.end() - 1}), "");  // without the trailer
  GifMaker short_table(1, 1, {0, 0, 0, 9, 9, 9});
  short_table.frame({.width = 1, .height = 1, .indices = {3}});
  EXPECT_EQ(error_of(short_table.end()), "a.gif: GIF: frame 1 names colour 3 of a table of 2");
  GifMaker few(2, 2, four_colors);
  few.frame({.width = 2, .height = 2, .indices = {1, 2}});
  EXPECT_EQ(error_of(few.end()), "a.gif: GIF: frame 1 is truncated");
  EXPECT_EQ(error_of(GifMaker(2, 2, four_colors).end()), "a.gif: GIF: it has no image");
  // Changed bytes end in an image or in one line.
  for (std::uint32_t i = 0; i < 400; ++i) {
    Bytes changed = file;
    changed[hash(i) % changed.size()] = static_cast<std::uint8_t>(hash(i + 1000));
    changed[hash(i + 5000) % changed.size()] ^= static_cast<std::uint8_t>(1 << i % 8);
    EXPECT_EQ(error_of(changed).find('\n'), std::string::npos) << i;
  }
}

}  // namespace
}  // namespace zoneplate
