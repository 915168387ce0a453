// SPDX-License-Identifier: Apache-2.0
// What the verb calls identical: tests that run the built program on files whose stored values differ.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/inspect/exr_parts_for_test.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/webp.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/html_page_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

constexpr float infinity = std::numeric_limits<float>::infinity();

class Equality : public ProgramTest {
 protected:
  static constexpr int side = 16;

  /// An EXR of floats, grey but for a patch of 4 × 4 pixels; with a layer Z if `depth` is given.
  void save_exr(const std::string& name, Linear patch, std::optional<float> depth = std::nullopt,
                const ExrAttributes& attributes = {}) const {
    LinearImage image(side, side, {0.5f, 0.5f, 0.5f, 1});
    Plane<float> z(side, side, 3.0f);
    for (int y = 4; y < 8; ++y)
      for (int x = 4; x < 8; ++x) {
        image(x, y) = patch;
        if (depth) z(x, y) = *depth;
      }
    std::vector<ExrChannel> channels = rgba_channels(image);
    for (ExrChannel& channel : channels) channel.type = ExrType::Float;
    if (depth) channels.push_back({"Z", ExrType::Float, z.values().data(), nullptr, 1});
    save(name, encode_exr(side, side, channels, attributes));
  }
  ProgramAnswer run(const std::string& arguments) const { return ProgramTest::run("metrics " + arguments); }
  /// Requires the exit code of a difference without a threshold, and this remark.
  void expect_different(const std::string& files, const std::string& remark) const {
    const ProgramAnswer answer = run(files + " --metric psnr");
    EXPECT_EQ(answer.code, 1) << answer.out;
    EXPECT_FALSE(contains(answer.out, "identical")) << answer.out;
    EXPECT_TRUE(contains(answer.out, remark)) << answer.out;
  }
};

constexpr Linear grey{0.5f, 0.5f, 0.5f, 1};

TEST_F(Equality, IsOfTheStoredValuesOfLight) {
  struct Case {
    Linear a, b;
    const char* remark;
  };
  const float nan = std::nanf("");
  const Case cases[] = {{{5, 5, 5, 1}, {50, 50, 50, 1}, "stored values differ: R, G, B in 16 pixels"},
                        {{0, 0, 0, 1}, {nan, 0, 0, 1}, "not finite in the test image: R in 16 pixels"},
                        {{2, 2, 2, 1}, {2, infinity, 2, 1}, "not finite in the test image: G in 16 pixels"},
                        {{0, 0, 0, 1}, {-3, 0, 0, 1}, "stored values differ: R in 16 pixels"},
                        {{0, 0, 0, 0}, {4, 2, 1, 0}, "stored values differ: R, G, B in 16 pixels"},
                        {{0, 0, 0, 1}, {0, 0, 0, nan}, "not finite in the test image: A in 16 pixels"}};
  for (const Case& one : cases) {
    save_exr("a.exr", one.a), save_exr("b.exr", one.b);
    expect_different("a.exr b.exr", one.remark);
    expect_different("b.exr a.exr", "");
    EXPECT_EQ(run("b.exr b.exr --metric psnr").code, 0) << "an image equals itself";
  }
}

TEST_F(Equality, ValuesThatAreNotFiniteFailEveryThreshold) {
  save("black.pfm", encode_pfm(LinearImage(side, side, {0, 0, 0, 1})));
  save("nan.pfm", encode_pfm(LinearImage(side, side, {std::nanf(""), 0, 0, 1})));
  save("inf.pfm", encode_pfm(LinearImage(side, side, {0, 0, infinity, 1})));
  for (const char* files : {"black.pfm nan.pfm", "nan.pfm black.pfm", "nan.pfm nan.pfm", "inf.pfm inf.pfm"})
    for (const char* threshold : {"psnr=1", "mse=1", "ssim=-1", "psnr=-inf", "mae.max=1", "psnr=1 --aggregate mean"}) {
      const ProgramAnswer answer = run(fmt::format("{} --metric psnr,mse,ssim,mae --threshold {}", files, threshold));
      EXPECT_EQ(answer.code, 1) << files << threshold << answer.out;
      EXPECT_TRUE(contains(answer.out, "is not finite: ")) << answer.out;
    }
  const ProgramAnswer answer = run("nan.pfm inf.pfm --metric psnr --threshold 1 --json --junit j.xml --report r.html");
  const auto json = parsed_json(answer.out.substr(0, answer.out.find('\n')));
  EXPECT_EQ(json["items"][0]["not_finite"]["reference"]["R"], 256);
  EXPECT_EQ(json["items"][0]["not_finite"]["test"]["B"], 256);
  EXPECT_TRUE(contains(text_of(place / "j.xml"), "is not finite: R in 256 pixels"));
  EXPECT_TRUE(contains(content_of_page(text_of(place / "r.html")), "is not finite: R in 256 pixels"));
}

// The channel depth.Z of one part and the channel Z of a part "depth" have one name.
TEST_F(Equality, IsOfLayersWhoseNamesMeet) {
  const auto parts = [](float inside, float depth) {
    return exr_of_parts(
        8, {{"beauty", {{"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}, {"depth.Z", inside}}}, {"depth", {{"Z", depth}}}});
  };
  save("one.exr", parts(1, 3)), save("part.exr", parts(1, 9)), save("layer.exr", parts(2, 3));
  expect_different("one.exr part.exr", "depth.Z in 64 pixels");
  expect_different("one.exr layer.exr", "depth.Z in 64 pixels");
  EXPECT_EQ(run("one.exr one.exr --metric psnr").code, 0);
}

TEST_F(Equality, IsOfLayersAndParts) {
  save_exr("near.exr", grey, 3), save_exr("far.exr", grey, 9), save_exr("none.exr", grey);
  expect_different("near.exr far.exr", "stored values differ: Z in 16 pixels");
  expect_different("near.exr none.exr", "only the reference has Z");
  expect_different("none.exr near.exr", "only the test image has Z");
  save_exr("near2.exr", grey, 3, {{"comments", "other bytes"}});
  const ProgramAnswer same = run("near.exr near2.exr --metric psnr");
  EXPECT_EQ(same.code, 0) << same.out;
  EXPECT_TRUE(contains(same.out, "compared for equality only, and equal: Z")) << same.out;
  // A threshold is of what the metrics measure; the layer is named.
  const ProgramAnswer passed = run("near.exr far.exr --metric psnr --threshold 40");
  EXPECT_EQ(passed.code, 0) << passed.out;
  EXPECT_TRUE(contains(passed.out, "Z in 16 pixels")) << passed.out;
  // An infinite distance is a value, an undefined one is not.
  save_exr("open.exr", grey, infinity), save_exr("wrong.exr", grey, std::nanf(""));
  EXPECT_EQ(run("near.exr open.exr --metric psnr --threshold 40").code, 0);
  EXPECT_EQ(run("near.exr wrong.exr --metric psnr --threshold 40").code, 1);
  for (const char* folder : {"a", "b"}) {
    fs::create_directories(place / folder);
    for (const char* file : {"open.exr", "near.exr"}) fs::copy_file(place / file, place / folder / file);
  }
  EXPECT_FALSE(contains(run("a b --metric psnr").out, "open.exr")) << "nothing is to be said of it";

  const auto parts = [](float depth, float occlusion = 1) {
    return exr_of_parts(8, {{"left", {{"AO", occlusion, 2}, {"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}}},
                            {"right", {{"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}, {"Z", depth}}}});
  };
  save("p3.exr", parts(3)), save("p9.exr", parts(9));
  expect_different("p3.exr p9.exr", "stored values differ: right.Z in 64 pixels");
  EXPECT_TRUE(contains(run("p3.exr p9.exr").out, "equal: AO, right.B, right.G, right.R"));
  save("dark.exr", parts(3, 0));
  expect_different("p3.exr dark.exr", "stored values differ: AO in 16 pixels");  // of half as many columns and rows
}

// More layers than are in memory at once: they are compared in bands of rows.
TEST_F(Equality, IsOfManyLayersOfWideImages) {
  constexpr int width = 3600, height = 40;
  const LinearImage image(width, height, {0.5f, 0.5f, 0.5f, 1});
  Plane<float> values(width, height, 2.0f), changed = values;
  changed(5, 39) = changed(6, 39) = changed(7, 3) = 7, values(8, 20) = changed(8, 20) = std::nanf("");
  const auto file = [&](const Plane<float>& last) {
    std::vector<ExrChannel> channels = rgba_channels(image);
    for (int i = 0; i < 60; ++i)
      channels.push_back(
          {fmt::format("d.{}", i), i == 0 ? ExrType::Float : ExrType::Half, (i == 59 ? last : values).values().data()});
    return encode_exr(width, height, channels);
  };
  save("a.exr", file(values)), save("b.exr", file(changed));
  const ProgramAnswer answer = run("a.exr b.exr --metric psnr");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(contains(answer.out, "stored values differ: d.59 in 3 pixels")) << answer.out;
  for (const char* const of : {"the reference", "the test image"})
    EXPECT_TRUE(contains(answer.out, fmt::format("not finite in {}: d.0 in 1 pixel", of))) << answer.out;
  const ProgramAnswer same = run("a.exr a.exr --metric psnr");
  EXPECT_TRUE(contains(same.out, "not finite in the test image: d.0 in 1 pixel")) << same.out;
  EXPECT_TRUE(contains(same.out, "d.59")) << same.out;
}

TEST_F(Equality, IsOfTheMeaningOfTheValues) {
  const ExrChromaticities wide = {0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
  save_exr("a.exr", grey), save_exr("b.exr", grey, std::nullopt, {{"chromaticities", wide}});
  save_exr("c.exr", grey, std::nullopt, {{"chromaticities", rec709_chromaticities}});
  expect_different("a.exr b.exr", "the values mean Rec.709 light in the reference, chromaticities 0.7347 0.2653");
  EXPECT_EQ(run("a.exr c.exr").code, 0);
  const std::vector<std::uint8_t> plain = encode_png(Rgba8Image(side, side, {9, 9, 9, 255}), {.is_srgb = false});
  std::vector<std::uint8_t> linear(plain.begin(), plain.begin() + 33), gamma;
  put_png_word(gamma, 100000);
  put_png_chunk(linear, "gAMA", gamma);
  linear.insert(linear.end(), plain.begin() + 33, plain.end());
  save("plain.png", plain), save("linear.png", linear);
  save("srgb.png", encode_png(Rgba8Image(side, side, {9, 9, 9, 255})));
  expect_different("plain.png linear.png", "gAMA 1 in the test image");
  EXPECT_EQ(run("plain.png srgb.png").code, 0);
  EXPECT_EQ(run("linear.png linear.png").code, 0);
}

TEST_F(Equality, IsOfAllBitsAndHiddenColours) {
  const Rgba16Image fine(side, side, Rgba16{30001, 2, 65535, 65535}), finer(side, side, Rgba16{30002, 2, 65535, 65535});
  save("a.png", encode_png(fine)), save("b.png", encode_png(finer));
  expect_different("a.png b.png", "stored values differ: R in 256 pixels");
  save("hidden.png", encode_png(Rgba8Image(side, side, {255, 0, 0, 0})));
  save("clear.png", encode_png(Rgba8Image(side, side, {0, 0, 0, 0})));
  expect_different("clear.png hidden.png", "stored values differ: R in 256 pixels");
  save("code8.png", encode_png(Rgba8Image(side, side, {1, 128, 255, 255})));
  save("code16.png", encode_png(Rgba16Image(side, side, {257, 128 * 257, 65535, 65535})));
  EXPECT_EQ(run("code8.png code16.png").code, 0);
}

TEST_F(Equality, AnimationsAreSequences) {
  Animation animation{.format = {.seconds = 1, .per = 10, .has_alpha = true}, .frames = {}};
  for (int i = 0; i < 3; ++i) {
    Rgba8Image& frame = animation.frames.emplace_back(side, side, Rgba8{50, 100, 9, 255});
    for (int y = 0; y < 5; ++y) frame(4 * i, y) = {255, 0, 0, static_cast<std::uint8_t>(y * 60)};
    save(fmt::format("frames/f.{:04}.png", i), encode_png(frame));
  }
  save("film.png", encode_apng(animation)), save("film.webp", encode_webp(animation));
  save("still.png", encode_png(animation.frames[0]));
  for (const char* operands : {"film.png film.webp", "frames/f.####.png film.webp", "film.png frames/f.####.png"}) {
    const ProgramAnswer answer = run(std::string(operands) + " --metric psnr,tpsnr,cvvdp");
    EXPECT_EQ(answer.code, 0) << operands << answer.out;
    EXPECT_TRUE(contains(answer.out, "tpsnr")) << answer.out;
  }
  // A frame that differs is named; another number of frames is an error.
  animation.frames[1](7, 7) = {0, 0, 0, 255};
  save("other.webp", encode_webp(animation));
  const ProgramAnswer other = run("film.png other.webp");
  EXPECT_EQ(other.code, 1);
  EXPECT_TRUE(contains(other.out, "frame 2")) << other.out;
  EXPECT_FALSE(contains(other.out, "failed       frame 1")) << other.out;
  animation.frames.pop_back();
  save("short.png", encode_apng(animation));
  const ProgramAnswer few = run("film.png short.png");
  EXPECT_EQ(few.code, 1);
  EXPECT_TRUE(contains(few.out, "missing      frame 3")) << few.out;
  EXPECT_EQ(run("film.png still.png").code, 1);
  EXPECT_EQ(run("still.png - < still.png").code, 0);
  EXPECT_EQ(run("film.png - < film.webp").code, 0);
}

TEST_F(Equality, NamesWhatIsNotComparedInFolders) {
  Animation animation;
  for (int i = 0; i < 3; ++i)
    animation.frames.emplace_back(side, side, Rgba8{static_cast<std::uint8_t>(40 * i), 0, 0, 255});
  save("a/film.png", encode_apng(animation)), save("b/film.png", encode_png(animation.frames[0]));
  save("b/y.mp4", {0, 0, 0, 9, 'f', 't', 'y', 'p'});
  const ProgramAnswer answer = run("a b");
  EXPECT_TRUE(contains(answer.out, "the reference is an animation of 3 frames, of which the first is compared"))
      << answer.out;
  EXPECT_TRUE(contains(answer.out, "not compared: y.mp4")) << answer.out;
}

TEST_F(Equality, SequencesPairByNumber) {
  fs::create_directories(place / "a"), fs::create_directories(place / "b");
  for (int i = 0; i < 8; ++i) {
    const auto frame = encode_png(Rgba8Image(side, side, {static_cast<std::uint8_t>(30 * i), 9, 9, 255}));
    if (i != 3) save(fmt::format("a/f.{:04}.png", i), frame);
    if (i != 5) save(fmt::format("b/f.{:04}.png", i), frame);
    save(fmt::format("a/g.{:04}.png", i), frame), save(fmt::format("b/g.{:04}.png", i + 1), frame);
  }
  const ProgramAnswer answer = run("a/f.####.png b/f.####.png --metric psnr");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(contains(answer.out, "new          f.0003.png: there is no reference of this number")) << answer.out;
  EXPECT_TRUE(contains(answer.out, "missing      f.0005.png: there is no test image of this number")) << answer.out;
  EXPECT_TRUE(contains(answer.out, "2 of 8 images failed")) << answer.out;
  const ProgramAnswer shifted = run("a/g.####.png b/g.####.png --metric psnr");
  EXPECT_TRUE(contains(shifted.out, "the references are 0 to 7, the test images 1 to 8")) << shifted.out;
  // Photographs in a folder are no frames, unless a metric of several frames is named.
  fs::create_directories(place / "c");
  for (int i = 0; i < 3; ++i) save(fmt::format("c/photo{}.png", i), encode_png(Rgba8Image(side, side, {9, 9, 9, 255})));
  EXPECT_FALSE(contains(run("c c").out, "flicker"));
  EXPECT_TRUE(contains(run("c c --metric flicker").out, "flicker"));
  EXPECT_TRUE(contains(run("c/photo#.png c/photo#.png").out, "flicker"));
}

TEST_F(Equality, OtherSizesAreNamedWithEveryMetric) {
  save("small.png", encode_png(Rgba8Image(12, 12, {9, 9, 9, 255})));
  save("large.png", encode_png(Rgba8Image(24, 24, {9, 9, 9, 255})));
  for (const char* files : {"small.png large.png", "large.png small.png"}) {
    const ProgramAnswer answer = run(std::string(files) + " --metric all");
    EXPECT_EQ(answer.code, 1) << answer.out;
    EXPECT_TRUE(contains(answer.out, "as the reference")) << answer.out;
    EXPECT_EQ(run(std::string(files) + " --metric all --threshold psnr=1").code, 1);
  }
}

TEST_F(Equality, AThresholdOfAMetricWithoutValueFails) {
  save("a.png", encode_png(Rgba8Image(side, side, {9, 9, 9, 255})));
  const ProgramAnswer small = run("a.png a.png --threshold psnr=1,flicker=1");
  EXPECT_EQ(small.code, 1) << small.out;
  EXPECT_TRUE(contains(small.out, "flicker has no value")) << small.out;
  EXPECT_TRUE(contains(run("a.png a.png --metric all --threshold ms_ssim=0.5").out, "ms_ssim has no value"));
}

TEST_F(Equality, SilhouettesAreSeenOverBlackAndOverWhite) {
  Rgba8Image logo(32, 32, {0, 0, 0, 0});
  for (int y = 8; y < 24; ++y)
    for (int x = 8; x < 24; ++x) logo(x, y).a = 255;
  save("logo.png", encode_png(logo));
  save("gone.png", encode_png(Rgba8Image(32, 32, {0, 0, 0, 0})));
  save("black.png", encode_png(Rgba8Image(32, 32, {0, 0, 0, 255})));
  for (const char* other : {"gone.png", "black.png"})
    for (const char* threshold : {"ssim --threshold 0.999", "flip --threshold 0.001", "psnr --threshold 60",
                                  "mse --threshold 0", "mae --threshold mae.max=0.5", "cvvdp --threshold 9.9",
                                  "edge_error --threshold 0.01", "yiq_rms --threshold -40"}) {
      EXPECT_EQ(run(fmt::format("logo.png {} --metric {}", other, threshold)).code, 1) << other << threshold;
      EXPECT_EQ(run(fmt::format("logo.png logo.png --metric {}", threshold)).code, 0) << threshold;
    }
}

}  // namespace
}  // namespace zoneplate
