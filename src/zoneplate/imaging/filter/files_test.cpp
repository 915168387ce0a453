// SPDX-License-Identifier: Apache-2.0
// Which files the verb pairs, writes and keeps: tests that run the built program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/imaging/filter/still.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

constexpr int side = 16;
constexpr float infinity = std::numeric_limits<float>::infinity();

class FilterFiles : public ProgramTest {
 protected:
  ProgramAnswer run(const std::string& arguments) const { return ProgramTest::run("filter " + arguments); }
  /// An image with an edge, which every filter changes.
  void save_png(const std::string& name) const {
    Rgba8Image image(side, side, {0, 0, 0, 255});
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < 4 + y / 3; ++x) image(x, y) = {255, 255, 255, 255};
    save(name, encode_png(image));
  }
  /// A frame of colour, or one pass of it, with the channels R, G and B.
  void save_exr(const std::string& name, const LinearImage& image) const {
    std::vector<ExrChannel> channels = rgba_channels(image);
    for (ExrChannel& channel : channels) channel.type = ExrType::Float;
    save(name, encode_exr(image.width(), image.height(), channels));
  }
  void save_flat(const std::string& name, float value) const {
    save_exr(name, LinearImage(side, side, {value, value, value, 1}));
  }
  /// Requires that a run is refused with this text, and writes nothing.
  void expect_refused(const std::string& arguments, int code, const std::string& text) const {
    const ProgramAnswer answer = run(arguments);
    EXPECT_EQ(answer.code, code) << answer.out;
    EXPECT_TRUE(contains(answer.out, text)) << answer.out;
    EXPECT_FALSE(exists("out"));
  }
};

TEST_F(FilterFiles, PassesPairByTheNumbersOfTheirFrames) {
  for (int i = 0; i < 8; ++i) {
    if (i != 2) save_flat(fmt::format("c.{:04}.exr", i), 0.3f);
    if (i != 4) save_flat(fmt::format("z.{:04}.exr", i), 4);
    if (i != 6) save_flat(fmt::format("v.{:04}.exr", i), 0);
    save_flat(fmt::format("whole/c.{:04}.exr", i), 0.3f);
    save_flat(fmt::format("depth/z.{:04}.exr", i), 4);
    save_flat(fmt::format("late/v.{:04}.exr", i + 1), 0);
  }
  expect_refused("c.####.exr --depth z.####.exr --motion v.####.exr --aa taa -o out", 3,
                 "c.####.exr has no frame 2; --depth z.####.exr has no frame 4; --motion v.####.exr has no frame 6");
  for (const char* passes : {"whole/c.####.exr --depth depth/z.####.exr --motion late/v.####.exr",
                             "whole --depth depth --motion late/v.####.exr", "whole --depth depth --motion late"})
    expect_refused(std::string(passes) + " --aa taa -o out", 3, "has no frame 8; --motion late");
  EXPECT_EQ(run("whole --depth depth/z.####.exr --motion whole --motion-scale 0,0 --aa taa -o out").code, 0);
}

TEST_F(FilterFiles, AGapIsNamed) {
  for (const int i : {0, 1, 4}) save_flat(fmt::format("c.{}.exr", i), 0.3f);
  const ProgramAnswer answer = run("c.#.exr --depth c.#.exr --motion c.#.exr --motion-scale 0,0 --aa taa -o out");
  EXPECT_EQ(answer.code, 0) << answer.out;
  EXPECT_TRUE(contains(answer.out, "c.#.exr: has no frame 2, 3: the history goes on without them")) << answer.out;
}

TEST_F(FilterFiles, NamesWithAFrameNumberAreFiles) {
  save_png("n.07.png"), save_png("n.08.png");
  EXPECT_EQ(run("'n.##.png' -o 'o.###.png' --aa smaa").code, 0);
  EXPECT_TRUE(fs::is_regular_file(place / "o.007.png") && fs::is_regular_file(place / "o.008.png"));
  EXPECT_EQ(run("'n.##.png' -o 'made/o.%02d.png' --aa smaa").code, 0);
  EXPECT_TRUE(exists("made/o.07.png"));
  save_png("photos/tree.png"), save_png("photos/house.png");
  expect_refused("photos -o 'out.##.png' --aa smaa", 2, "is no frame of a sequence");
  EXPECT_FALSE(exists("o.###.png") || exists("out.##.png"));
}

TEST_F(FilterFiles, InputsAreKeptUnlessForced) {
  save_png("shots/a.png"), save_png("shots/b.png"), save_png("single.png");
  fs::create_directory_symlink(place / "shots", place / "link");
  fs::create_symlink(place / "single.png", place / "other.png");
  const std::string before = text_of(place / "shots/a.png");
  const std::string absolute = "shots -o '" + (place / "shots").string() + "'";
  for (const std::string& names :
       {std::string("shots -o shots"), std::string("shots/ -o shots/"), std::string("shots -o ./shots/../shots"),
        std::string("shots -o link"), std::string("link -o shots"), absolute})
    expect_refused(names + " --aa smaa", 2, "would replace the input");
  expect_refused("single.png -o single.png --aa smaa", 2, "single.png: would replace the input single.png");
  expect_refused("single.png -o other.png --aa smaa", 2, "other.png: would replace the input single.png");
  for (int i = 0; i < 2; ++i) save_png(fmt::format("f.{}.png", i)), save_flat(fmt::format("z.{}.exr", i), 4);
  expect_refused("f.#.png -o f.#.png --aa smaa", 2, "would replace the input");
  expect_refused("f.#.png -o . --aa smaa", 2, "would replace the input");
  expect_refused("z.#.exr --depth z.#.exr --motion z.#.exr --aa taa -o .", 2, "would replace the input");
  EXPECT_EQ(text_of(place / "shots/a.png"), before);
  EXPECT_EQ(run("shots -o shots --aa smaa --force").code, 0);
  EXPECT_NE(text_of(place / "shots/a.png"), before);
  EXPECT_EQ(run("shots -o out --aa smaa").code, 0);
}

TEST_F(FilterFiles, OtherFormatsAreNamed) {
  using namespace std::string_literals;
  const std::pair<const char*, std::string> files[] = {{"a QOI image", "qoif"},
                                                       {"a KTX2 image", "\xabKTX 20"},
                                                       {"a HEIC image", "\0\0\0\x1c"s + "ftypheic"},
                                                       {"an MP4 video", "\0\0\0\x1c"s + "ftypisom"}};
  for (const auto& [format, bytes] : files) {
    save("x.bin", std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
    expect_refused("x.bin -o out.png --aa smaa", 3,
                   fmt::format("x.bin: is {}, expected PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, BMP "
                               "or TGA",
                               format));
  }
}

TEST_F(FilterFiles, BitmapsAreRead) {
  const std::vector<std::uint8_t> tga = {0, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0, side, 0, side, 0, 8, 0, 0xff, 7, 0xff, 7};
  std::vector<std::uint8_t> bmp = {'B', 'M', 0, 0,    0, 0, 0, 0,    0, 0, 54, 0, 0, 0, 40,
                                   0,   0,   0, side, 0, 0, 0, side, 0, 0, 0,  1, 0, 24};
  bmp.resize(54 + 3 * side * side, 0);
  std::fill(bmp.begin() + 54, bmp.end(), std::uint8_t{7});
  save("in/a.tga", tga), save("in/b.bmp", bmp);
  const ProgramAnswer answer = run("in -o out --aa smaa");
  EXPECT_EQ(answer.code, 0) << answer.out;
  for (const char* name : {"out/a.png", "out/b.png"}) {
    const FileBytes file((place / name).string());
    EXPECT_EQ(decode_png(file.bytes(), name).pixels, Rgba8Image(side, side, {7, 7, 7, 255})) << name;
  }
  const ProgramAnswer equal = ProgramTest::run("metrics in/a.tga in/b.bmp");
  EXPECT_EQ(equal.code, 0) << equal.out;
}

// What libjpeg decodes is kept, by every verb of images.
TEST_F(FilterFiles, DamagedJpegsGiveAWarning) {
  std::vector<std::uint8_t> jpeg = encode_jpeg(Rgba8Image(side, side, {200, 9, 9, 255}));
  save("whole.jpg", jpeg);
  jpeg.resize(jpeg.size() - 2);
  save("cut.jpg", jpeg);
  for (const char* arguments : {"filter cut.jpg -o a.png --aa smaa", "metrics whole.jpg cut.jpg",
                                "signal resample cut.jpg -o b.png --size 50%", "texture levels cut.jpg"}) {
    const ProgramAnswer answer = ProgramTest::run(arguments);
    EXPECT_EQ(answer.code, 0) << answer.out;
    EXPECT_TRUE(contains(answer.out, "warning: cut.jpg: JPEG: Premature end of JPEG file")) << answer.out;
  }
}

// Opaque red columns and transparent green ones between them.
TEST_F(FilterFiles, MipLevelsHideWhatAlphaHides) {
  Rgba8Image columns(side, side, {255, 0, 0, 255});
  for (int y = 0; y < side; ++y)
    for (int x = 1; x < side; x += 2) columns(x, y) = {0, 255, 0, 0};
  save("columns.png", encode_png(columns));
  const auto greenest = [&](const char* options) {
    const ProgramAnswer answer = ProgramTest::run(fmt::format("texture levels columns.png -o levels.png{}", options));
    EXPECT_EQ(answer.code, 0) << answer.out;
    const FileBytes file((place / "levels.png").string());
    const Rgba8Image levels = decode_png(file.bytes(), "levels.png").pixels;
    int most = 0;
    for (const Rgba8 c : levels.values()) most = std::max(most, int{c.g});
    return most;
  };
  EXPECT_EQ(greenest(""), 0);
  EXPECT_EQ(greenest(" --mip-filter kaiser"), 0);
  EXPECT_EQ(greenest(" --ripmap"), 0);
  EXPECT_EQ(greenest(" --straight-alpha"), 255);
  EXPECT_EQ(greenest(" --values"), 255);
}

TEST_F(FilterFiles, WhatIsNotFiniteDoesNotEnterTheHistory) {
  for (int i = 0; i < 6; ++i) {
    LinearImage image(side, side, {0.25f, 0.25f, 0.25f, 1});
    if (i == 2) image(5, 5) = {std::nanf(""), 0.25f, 0.25f, 1}, image(10, 10) = {0.25f, infinity, 0.25f, 1};
    save_exr(fmt::format("c.{}.exr", i), image);
    save_flat(fmt::format("z.{}.exr", i), 4), save_flat(fmt::format("v.{}.exr", i), 0);
  }
  for (const char* method : {"--aa taa", "--aa history-guided", "--upscale fsr2:scale=1.5", "--upscale taau:scale=2",
                             "--upscale sgsr2:scale=2", "--upscale fsr3:scale=2", "--upscale learned"}) {
    const ProgramAnswer answer = run(fmt::format("c.#.exr --depth z.#.exr --motion v.#.exr {} -o out", method));
    EXPECT_EQ(answer.code, 0) << answer.out;
    EXPECT_TRUE(contains(answer.out, "c.2.exr: 2 pixels are not finite")) << answer.out;
    for (int i = 0; i < 6; ++i) {
      const FileBytes file((place / fmt::format("out/c.{}.exr", i)).string());
      const LinearImage image = decode_exr_as_stored(file.bytes(), "out");
      for (const Linear& c : image.values()) {
        ASSERT_NEAR(c.r, 0.25f, 0.005f) << method << i;
        ASSERT_NEAR(c.g, 0.25f, 0.005f) << method << i;
      }
    }
  }
}

TEST_F(FilterFiles, StillsFillWhatIsNotFiniteAsSequencesDo) {
  LinearImage image(side, side, {0.25f, 0.25f, 0.25f, 1});
  image(5, 5) = {std::nanf(""), 0.25f, 0.25f, 1}, image(10, 10) = {0.25f, infinity, 0.25f, 1};
  save_exr("c.exr", image), save_flat("flat.exr", 0.25f);
  const ProgramAnswer answer = run("c.exr -o large.exr --upscale fsr1:scale=2");
  EXPECT_EQ(answer.code, 0) << answer.out;
  EXPECT_TRUE(contains(answer.out, "c.exr: 2 pixels are not finite, and take the mean of neighbours")) << answer.out;
  ASSERT_EQ(run("flat.exr -o expected.exr --upscale fsr1:scale=2").code, 0);
  const FileBytes file((place / "large.exr").string()), expected((place / "expected.exr").string());
  EXPECT_TRUE(std::ranges::equal(file.bytes(), expected.bytes()));
}

// As `signal` does, where the result has the size of the image and is an EXR.
TEST_F(FilterFiles, OverscanIsKeptAndFiltered) {
  LinearImage image(side + 8, side + 8, {0, 0, 0, 1});
  for (int y = 0; y < side + 8; ++y)
    for (int x = 0; x < 6 + y / 3; ++x) image(x, y) = {1, 1, 1, 1};
  const ExrWindow data{-4, -4, side + 3, side + 3}, display{0, 0, side - 1, side - 1};
  std::vector<ExrChannel> channels = rgba_channels(image);
  for (ExrChannel& channel : channels) channel.type = ExrType::Float;
  const ExrPartBytes part = encode_exr_part({.data = data, .display = display, .channels = channels});
  save("c.exr", join_exr_parts({part}));
  save_exr("whole.exr", image);
  const auto pixels = [&](const char* name, ExrArea area) {
    const FileBytes file((place / name).string());
    return decode_exr_as_stored(file.bytes(), name, 1 << 20, {.area = area});
  };
  ProgramAnswer answer = run("c.exr --aa smaa -o out.exr");
  EXPECT_EQ(answer.code, 0);
  EXPECT_EQ(answer.out, "");
  ASSERT_EQ(run("whole.exr --aa smaa -o expected.exr").code, 0);
  EXPECT_EQ(pixels("out.exr", ExrArea::Whole), pixels("expected.exr", ExrArea::Whole));
  EXPECT_NE(pixels("out.exr", ExrArea::Whole), pixels("c.exr", ExrArea::Whole));
  EXPECT_EQ(pixels("out.exr", ExrArea::Display).width(), side);
  answer = run("c.exr --upscale bilinear:scale=2 -o large.exr");
  EXPECT_TRUE(contains(answer.out, "lacks what c.exr has beside the layer: the pixels outside the display window"))
      << answer.out;
  EXPECT_EQ(pixels("large.exr", ExrArea::Whole).width(), 2 * side);
}

// A warning about a frame is not repeated for the frames after it, but for another image.
TEST_F(FilterFiles, FramesRepeatNoWarning) {
  for (int i = 0; i < 5; ++i) {
    LinearImage image(side, side, {0.25f, 0.25f, 0.25f, 1});
    for (int k = 0; k <= i; ++k) image(k, 5).r = infinity;
    save_exr(fmt::format("c.{}.exr", i), image);
  }
  save_exr("other.exr", LinearImage(side, side, {-1, 2, 0.25f, 1}));
  const ProgramAnswer answer = run("c.#.exr -o out --upscale bilinear:scale=2");
  EXPECT_EQ(answer.code, 0);
  EXPECT_TRUE(contains(answer.out, "c.0.exr: 1 pixel is not finite")) << answer.out;
  EXPECT_TRUE(contains(answer.out, "c.1.exr: 2 pixels are not finite")) << answer.out;
  EXPECT_FALSE(contains(answer.out, "c.2.exr")) << answer.out;
  EXPECT_TRUE(contains(answer.out, "c.#.exr: 3 more warnings are those above, of other frames")) << answer.out;
  const ProgramAnswer all = run(". -o all --upscale fsr1");
  EXPECT_TRUE(contains(all.out, "other.exr: ")) << all.out;
}

TEST_F(FilterFiles, TheLimitOfPixelsHoldsForPasses) {
  const LinearImage large(2 * side, side, {4, 4, 4, 1});
  for (int i = 0; i < 2; ++i) {
    save_flat(fmt::format("c.{}.exr", i), 0.3f);
    save_flat(fmt::format("v.{}.exr", i), 0);
    save_exr(fmt::format("z.{}.exr", i), large);
  }
  const std::string frames = "c.#.exr --motion v.#.exr --depth z.#.exr --aa taa -o out/";
  const ProgramAnswer unequal = run(frames), limited = run(fmt::format("{} --max-pixels {}", frames, side * side));
  EXPECT_EQ(unequal.code, 3);
  EXPECT_TRUE(contains(unequal.out, "z.0.exr: has 32x16 pixels, expected 16x16")) << unequal.out;
  EXPECT_EQ(limited.code, 3);
  EXPECT_TRUE(contains(limited.out, "z.0.exr: EXR: 32 x 16 pixels, at most 256 are allowed")) << limited.out;
  EXPECT_FALSE(exists("out/c.0.exr"));
}

TEST(FillNotFinite, GoesFromTheBorderInwards) {
  LinearImage image(5, 5, {1, 2, 3, 1});
  for (int y = 1; y < 5; ++y)
    for (int x = 1; x < 5; ++x) image(x, y).g = std::nanf("");
  EXPECT_EQ(fill_not_finite(image, "a"), 16u);
  for (const Linear& c : image.values()) EXPECT_EQ(c, (Linear{1, 2, 3, 1}));
  EXPECT_EQ(fill_not_finite(image, "a"), 0u);
  LinearImage none(2, 2, {infinity, 0, 0, 1});
  EXPECT_ANY_THROW(fill_not_finite(none, "a"));
}

}  // namespace
}  // namespace zoneplate
