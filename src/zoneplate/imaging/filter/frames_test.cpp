// SPDX-License-Identifier: Apache-2.0
// Animations that are filtered as sequences: tests that run the built program.
#include "zoneplate/imaging/filter/frames.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/codec/animated/gif_file_for_test.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

constexpr int width = 17, height = 15;
constexpr FrameTime times[] = {{1, 10}, {3, 100}, {1, 2}, {7, 100}};

class FilterFrames : public ProgramTest {
 protected:
  ProgramAnswer run(const std::string& arguments) const { return ProgramTest::run("filter " + arguments); }
  /// A frame with an edge, which every filter changes.
  static Rgba8Image frame(int i, std::uint8_t alpha) {
    Rgba8Image image(width, height, {0, 40, 0, 255});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < 4 + i + y / 3; ++x) image(x, y) = {250, 250, 250, alpha};
    return image;
  }
  static std::vector<std::uint8_t> film(std::unique_ptr<AnimationEncoder> encoder, std::uint8_t alpha) {
    for (int i = 0; i < 4; ++i) encoder->add(std::make_shared<const Rgba8Image>(frame(i, alpha)), times[i])();
    return encoder->finish();
  }
  static std::vector<std::uint8_t> apng(std::uint8_t alpha = 200) {
    return film(make_apng_encoder({.loops = 3, .has_alpha = alpha != 255}), alpha);
  }
  /// The frames of a file that is an animation, and what each image of the same frames is filtered to.
  void expect_filtered(const std::string& output, std::uint8_t alpha = 200) const {
    const FileBytes file((place / output).string());
    const auto reader = open_animation(file.bytes(), output, 1 << 20);
    ASSERT_TRUE(reader) << output;
    ASSERT_EQ(reader->info().frames, 4u) << output;
    for (int i = 0; i < 4; ++i) {
      save("still.png", encode_png(frame(i, alpha)));
      ASSERT_EQ(run("still.png --aa smaa -o expected.png --force").code, 0);
      const FileBytes expected((place / "expected.png").string());
      const AnimationFrame found = reader->next();
      EXPECT_EQ(found.image.as<Rgba8>(), decode_png(expected.bytes(), "expected").pixels) << output << i;
      EXPECT_EQ(found.time.seconds * times[i].per, times[i].seconds * found.time.per) << output << i;
    }
  }
};

TEST_F(FilterFrames, AnimationsKeepTheirTimes) {
  save("film.apng", apng()), save("film.webp", film(make_webp_encoder({.has_alpha = true}), 200));
  for (const char* input : {"film.apng", "film.webp"})
    for (const char* output : {"out.apng", "out.webp", "out.png"}) {
      const ProgramAnswer answer = run(fmt::format("{} --aa smaa -o {}", input, output));
      EXPECT_EQ(answer.code, 0) << answer.out;
      EXPECT_EQ(answer.out, "");
      expect_filtered(output);
    }
  const FileBytes file((place / "out.png").string());
  ASSERT_EQ(run("film.apng --aa smaa -o out.apng").code, 0);
  const FileBytes looped((place / "out.apng").string());
  EXPECT_EQ(open_animation(looped.bytes(), "out.apng", 1 << 20)->info().loops, 3);
}

TEST_F(FilterFrames, GifsAreAnimationsToo) {
  GifMaker maker(4, 2, {0, 0, 0, 255, 255, 255}, 0);
  maker.frame({.width = 4, .height = 2, .indices = {0, 0, 1, 1, 0, 0, 1, 1}, .delay = 5}, 2)
      .frame({.x = 1, .width = 1, .height = 1, .indices = {1}, .delay = 9}, 2);
  save("a.gif", maker.end());
  ASSERT_EQ(run("a.gif --upscale bilinear:scale=2 -o a.apng").code, 0);
  const FileBytes file((place / "a.apng").string());
  const auto reader = open_animation(file.bytes(), "a.apng", 1 << 20);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->info().size.x, 8);
  EXPECT_EQ(reader->info().loops, 0);
  EXPECT_EQ(reader->next().time, (FrameTime{5, 100}));
  EXPECT_EQ(reader->next().time, (FrameTime{9, 100}));
}

TEST_F(FilterFrames, FramesMayBecomeImages) {
  save("film.apng", apng(255));
  fs::create_directories(place / "folder");
  ASSERT_EQ(run("film.apng --aa smaa -o f.####.png").code, 0);
  ASSERT_EQ(run("film.apng --aa smaa -o folder").code, 0);
  ASSERT_EQ(run("film.apng --aa smaa -o new/").code, 0);
  ASSERT_EQ(run("film.apng --aa smaa -o deep.##.png --bit-depth 16").code, 0);
  save("last.png", encode_png(frame(3, 255)));
  ASSERT_EQ(run("last.png --aa smaa -o last_smooth.png").code, 0);
  const std::string expected = text_of(place / "last_smooth.png");
  for (const char* name : {"f.0003.png", "folder/film.0003.png", "new/film.0003.png"})
    EXPECT_EQ(text_of(place / name), expected) << name;
  EXPECT_FALSE(exists("f.0004.png"));
  const FileBytes deep((place / "deep.03.png").string());
  EXPECT_FALSE(decode_png(deep.bytes(), "deep").pixels16.empty());
  // The images are those of `metrics` too.
  EXPECT_EQ(run("film.apng --aa smaa -o all.webp").code, 0);
  const ProgramAnswer equal = ProgramTest::run("metrics f.####.png all.webp");
  EXPECT_EQ(equal.code, 0) << equal.out;
}

TEST_F(FilterFrames, InputsAreKeptAndOutputsChecked) {
  save("f.0001.png", apng());
  const ProgramAnswer kept = run("f.0001.png --aa smaa -o f.####.png");
  EXPECT_EQ(kept.code, 2);
  EXPECT_TRUE(contains(kept.out, "would replace the input")) << kept.out;
  const ProgramAnswer still = run("f.0001.png --aa smaa -o out.jpg");
  EXPECT_EQ(still.code, 2);
  EXPECT_TRUE(contains(still.out, "f.0001.png: is an animation of 4 frames, and out.jpg is one image")) << still.out;
  EXPECT_EQ(run("f.0001.png --aa smaa -o out.exr").code, 2);
  EXPECT_EQ(run("f.0001.png --aa smaa -o out.apng --bit-depth 16").code, 2);
  const ProgramAnswer opaque = run("f.0001.png --aa smaa -o out.mp4");
  EXPECT_EQ(opaque.code, 2);
  EXPECT_TRUE(contains(opaque.out, "out.mp4: the image is not opaque, and H.264 video has no alpha")) << opaque.out;
  // One of several files is an image, and a folder takes a single image.
  save("in/a.png", apng()), save("in/b.png", encode_png(frame(0, 255)));
  const ProgramAnswer several = run("in --aa smaa -o out");
  EXPECT_EQ(several.code, 0);
  EXPECT_TRUE(contains(several.out, "is an animation of 4 frames, of which the first is filtered")) << several.out;
  EXPECT_EQ(run("in/b.png --aa smaa -o out --force").code, 0);
}

TEST_F(FilterFrames, MethodsWithHistoryTakeAnimations) {
  save("film.apng", apng(255));
  for (int i = 0; i < 4; ++i) {
    save(fmt::format("c.{}.png", i), encode_png(frame(i, 255)));
    const auto plane = [](float value) { return LinearImage(width, height, {value, value, value, 1}); };
    const auto exr = [&](float value) { return encode_exr(width, height, rgba_channels(plane(value))); };
    save(fmt::format("z.{}.exr", i), exr(5)), save(fmt::format("v.{}.exr", i), exr(0));
  }
  const std::string data = " --depth z.#.exr --motion v.#.exr --aa taa -o ";
  ASSERT_EQ(run("c.#.png" + data + "frames/").code, 0);
  ASSERT_EQ(run("film.apng" + data + "film_out.webp").code, 0);
  ASSERT_EQ(run("film.apng" + data + "images/f.#.png").code, 0);
  const ProgramAnswer film = ProgramTest::run("metrics frames film_out.webp");
  EXPECT_EQ(film.code, 2) << film.out;  // a folder is compared with a folder
  EXPECT_EQ(ProgramTest::run("metrics frames/c.#.png film_out.webp").code, 0);
  EXPECT_EQ(ProgramTest::run("metrics frames/c.#.png images/f.#.png").code, 0);
  const ProgramAnswer none = run("film.apng --aa taa -o x.webp");
  EXPECT_TRUE(contains(none.out, "film.apng, frame 1: has no channel of depth: give --depth FILES")) << none.out;
  fs::remove(place / "z.3.exr");
  const ProgramAnswer few = run("film.apng" + data + "x.webp");
  EXPECT_EQ(few.code, 3);
  EXPECT_TRUE(contains(few.out, "--depth: has 3 frames, expected 4")) << few.out;
}

TEST_F(FilterFrames, VideosGoThroughFfmpeg) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  save("film.apng", apng(255));
  for (const char* name : {"a.mkv", "a.webm", "a.mp4", "a.mov", "a.gif"}) {
    const ProgramAnswer answer = run(fmt::format("film.apng --aa smaa -o {}", name));
    ASSERT_EQ(answer.code, 0) << answer.out;
    const bool is_gif = std::string(name) == "a.gif";
    ASSERT_EQ(run(fmt::format("{} --aa smaa -o back.apng", name)).code, 0) << name;
    const FileBytes file((place / "back.apng").string());
    const auto reader = open_animation(file.bytes(), "back.apng", 1 << 20);
    ASSERT_TRUE(reader);
    ASSERT_EQ(reader->info().frames, 4u) << name;
    EXPECT_EQ(reader->info().size.x, is_gif || std::string(name) == "a.webm" ? width : width + 1) << name;
    for (int i = 0; i < (is_gif ? 4 : 3); ++i) {
      const FrameTime time = reader->next().time;
      EXPECT_NEAR(static_cast<double>(time.seconds) / time.per, static_cast<double>(times[i].seconds) / times[i].per,
                  0.002)
          << name << i;
    }
  }
  // Frames of 1 / 60 s: those that a GIF cannot show give their times to the next ones.
  const auto encoder = make_apng_encoder({.seconds = 1, .per = 60});
  for (int i = 0; i < 12; ++i) encoder->add(std::make_shared<const Rgba8Image>(frame(i % 4, 255)))();
  save("fast.apng", encoder->finish());
  ASSERT_EQ(run("fast.apng --aa smaa -o fast.gif").code, 0);
  const FileBytes gif((place / "fast.gif").string());
  const auto reader = open_animation(gif.bytes(), "fast.gif", 1 << 20);
  int sum = 0;
  for (std::size_t i = 0; i < reader->info().frames; ++i) {
    const FrameTime time = reader->next().time;
    EXPECT_GE(time.seconds, 2);
    sum += time.seconds;
  }
  EXPECT_EQ(sum, 20);
}

TEST_F(FilterFrames, AMissingFfmpegIsNamed) {
  save("film.apng", apng(255)), save("film.mp4", {0, 0, 0, 9, 'f', 't', 'y', 'p'});
  // Only the folders of the system are searched besides PATH, so that nothing is missing where it is installed there.
  if (std::system("ffmpeg -version >/dev/null 2>&1") == 0) {
    const ProgramAnswer answer = run("film.mp4 --aa smaa -o x.apng");
    EXPECT_EQ(answer.code, 3);
    EXPECT_TRUE(contains(answer.out, "film.mp4: ffmpeg: ")) << answer.out;
    return;
  }
  for (const char* arguments : {"film.apng --aa smaa -o x.mp4", "film.mp4 --aa smaa -o x.apng"}) {
    const ProgramAnswer answer = run(arguments);
    EXPECT_NE(answer.code, 0);
    EXPECT_TRUE(contains(answer.out, "ffmpeg")) << answer.out;
  }
}

}  // namespace
}  // namespace zoneplate
