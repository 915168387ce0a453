// SPDX-License-Identifier: Apache-2.0
// Tests of the verb that run the built program: its output, its map and its exit codes.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "zoneplate/cli/program_for_test.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

class MetricsVerb : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    save("black.png", 0);
    save("grey.png", 51);
  }

  void save(const std::string& name, std::uint8_t code, int side = 16) const {
    fs::create_directories((place / name).parent_path());
    save_bytes((place / name).string(), encode_png(Rgba8Image(side, side, {code, code, code, 255})));
  }
  ProgramAnswer run(const std::string& arguments) const { return ProgramTest::run("metrics " + arguments); }
  std::string at(const std::string& name) const { return (place / name).string(); }
};

TEST_F(MetricsVerb, SamePicturesAreZeroAndInfinite) {
  const ProgramAnswer answer = run("grey.png grey.png --json");
  EXPECT_EQ(answer.code, 0);
  const auto json = parsed_json(answer.out);
  EXPECT_EQ(json["identical"], true);
  EXPECT_EQ(json["metrics"]["mse"]["value"], 0);
  EXPECT_EQ(json["metrics"]["psnr"]["value"], "inf");
  EXPECT_EQ(json["metrics"]["ssim"]["value"], 1);
  EXPECT_EQ(json["metrics"]["flip"]["value"], 0);
  EXPECT_EQ(json["metrics"]["yiq_rms"]["value"], "-inf");
}

TEST_F(MetricsVerb, DifferentPicturesAnswerOne) {
  const ProgramAnswer answer = run("black.png grey.png");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(contains(answer.out, "1 image, 16 × 16\n")) << answer.out;
  EXPECT_TRUE(contains(answer.out, "mse")) << answer.out;
  EXPECT_TRUE(contains(answer.out, "0.04 ")) << answer.out;
  EXPECT_TRUE(answer.out.ends_with("\nzoneplate: the images differ\n")) << answer.out;
  EXPECT_FALSE(contains(answer.out, "error")) << answer.out;
}

TEST_F(MetricsVerb, ThresholdsDecide) {
  EXPECT_EQ(run("black.png grey.png --metric psnr --threshold 13.9").code, 0);
  const ProgramAnswer below = run("black.png grey.png --metric psnr --threshold 14");
  EXPECT_EQ(below.code, 1);
  EXPECT_TRUE(below.out.ends_with("\nzoneplate: psnr is 13.9794, the threshold is 14 or more\n")) << below.out;
  EXPECT_EQ(run("black.png grey.png --metric mse,mae --threshold mse=0.05,mae=0.2").code, 1);  // 51 / 255 > 0.2
  EXPECT_EQ(run("black.png grey.png --metric mse,mae --threshold mse=0.05,mae=0.21").code, 0);
  EXPECT_EQ(run("grey.png grey.png --metric psnr --threshold inf").code, 0);
}

TEST_F(MetricsVerb, ReadsEveryFormatThatRenderWrites) {
  for (const char* name : {"a.png", "a.webp", "a.jpg", "a.pfm", "a.exr"}) {
    const std::string command = "'" ZONEPLATE_PROGRAM "' render triangles --size 32x32 -o '" + at(name) + "' 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(run(std::string("a.png ") + name + " --metric psnr --threshold 30").code, 0) << name;
  }
  EXPECT_EQ(run("a.png a.webp").code, 0);
}

TEST_F(MetricsVerb, LumaAndWindowsAreParameters) {
  save_bytes(at("red.png"), encode_png(Rgba8Image(16, 16, {255, 0, 0, 255})));
  save_bytes(at("none.png"), encode_png(Rgba8Image(16, 16, {0, 0, 0, 255})));
  const auto psnr = [&](const std::string& parameter) {
    const std::string text = run("none.png red.png --json --metric psnr_luma" + parameter).out;
    return parsed_json(text.substr(0, text.find('\n')))["metrics"]["psnr_luma"]["value"].get<double>();
  };
  EXPECT_NEAR(psnr(""), -20 * std::log10(0.2126), 1e-6);
  EXPECT_NEAR(psnr(":rec=601"), -20 * std::log10(0.299), 1e-6);
  EXPECT_TRUE(contains(run("none.png red.png --metric psnr_luma:rec=650").out, "rec is '650', expected 601 or 709"));
  EXPECT_TRUE(contains(run("none.png red.png --metric ssim:window=7.5").out, "window is '7.5', expected 0, 2, 3"));
}

TEST_F(MetricsVerb, TroubleIsTwo) {
  for (const char* arguments :
       {"grey.png", "grey.png missing.png", "grey.png grey.png --metric flop", "grey.png grey.png --metric ms_ssim",
        "grey.png grey.png --threshold 3", "grey.png grey.png --map /no/such/folder/map.png", "--no-such-option"}) {
    const ProgramAnswer answer = run(arguments);
    EXPECT_EQ(answer.code, 2) << arguments << '\n' << answer.out;
    EXPECT_TRUE(contains(answer.out, "zoneplate: ")) << answer.out;
  }
}

TEST_F(MetricsVerb, SizesHaveToAgree) {
  save("small.png", 0, 8);
  const ProgramAnswer answer = run("grey.png small.png");
  EXPECT_EQ(answer.code, 2);
  EXPECT_TRUE(contains(answer.out, "image 1 has 8 × 8 pixels, expected 16 × 16 as the reference")) << answer.out;
}

TEST_F(MetricsVerb, WritesTheMapInMagma) {
  EXPECT_EQ(run("black.png grey.png --metric psnr,mae --map map.png").code, 1);
  const PngImage map = decode_png(FileBytes(at("map.png")).bytes(), "map.png");
  EXPECT_EQ(map.pixels(3, 3), metrics::magma(0.2f));
}

TEST_F(MetricsVerb, JudgesSequencesAndFolders) {
  for (int i = 0; i < 3; ++i) {
    save("a/f" + std::to_string(i) + ".png", 100);
    save("b/f" + std::to_string(i) + ".png", i == 1 ? 151 : 100);
  }
  const ProgramAnswer answer = run("a b --metric flicker,mae --json");
  EXPECT_EQ(answer.code, 1);
  const auto json = parsed_json(answer.out.substr(0, answer.out.find('\n')));
  EXPECT_EQ(json["images"], 3);
  EXPECT_NEAR(json["metrics"]["flicker"]["value"].get<double>(), 0.2, 1e-6);
  EXPECT_EQ(json["metrics"]["mae"]["worst"], 1);
  EXPECT_NEAR(json["metrics"]["mae"]["value"].get<double>(), 0.2 / 3, 1e-6);
  EXPECT_EQ(run("a/f#.png b/f#.png --metric flicker --threshold 0.3").code, 0);
}

TEST_F(MetricsVerb, ParametersReachTheirMetric) {
  const auto value = [&](const std::string& metric) {
    const auto json = parsed_json(run("black.png grey.png --threshold flip=1 --json --metric " + metric).out);
    return json["metrics"]["flip"]["value"].get<double>();
  };
  save("black.png", 0, 32);
  save("grey.png", 0, 32);
  Rgba8Image dot(32, 32, {0, 0, 0, 255});
  dot(16, 16) = {255, 255, 255, 255};
  save_bytes(at("grey.png"), encode_png(dot));
  EXPECT_NE(value("flip:ppd=20"), value("flip:ppd=40"));
  EXPECT_EQ(value("mae,flip:ppd=20,psnr"), value("flip:ppd=20"));
}

}  // namespace
}  // namespace zoneplate::cli
