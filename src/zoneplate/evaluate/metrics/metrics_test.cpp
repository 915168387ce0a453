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
#include <fstream>
#include <map>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/html_page_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate {
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
    const std::string command = "'" + std::string(program_file) +
                                "' render triangles --size 32x32 --background-color '#808080' -o '" + at(name) +
                                "' 2>&1";
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

TEST_F(MetricsVerb, WrongUsageIsTwo) {
  for (const char* arguments :
       {"grey.png", "grey.png grey.png --metric flop", "grey.png grey.png --threshold 3",
        "grey.png grey.png --map-gain 3", "grey.png grey.png --aggregate mean", ". grey.png", "--no-such-option"}) {
    const ProgramAnswer answer = run(arguments);
    EXPECT_EQ(answer.code, 2) << arguments << '\n' << answer.out;
    EXPECT_TRUE(contains(answer.out, "zoneplate: ")) << answer.out;
  }
}

TEST_F(MetricsVerb, UnreadableOperandsAreThreeAndOutputsFour) {
  save_bytes(at("bad.png"), std::vector<std::uint8_t>{1, 2, 3});
  fs::create_directories(place / "empty");
  EXPECT_EQ(run("grey.png missing.png").code, 3);
  EXPECT_EQ(run("grey.png bad.png").code, 3);
  EXPECT_EQ(run("empty empty").code, 3);
  for (const char* option : {"--map", "--report", "--junit"})
    EXPECT_EQ(run(std::string("grey.png grey.png ") + option + " /no/such/folder/file").code, 4) << option;
}

TEST_F(MetricsVerb, SizesHaveToAgree) {
  save("small.png", 0, 8);
  const ProgramAnswer answer = run("grey.png small.png");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(contains(answer.out, "8 × 8 pixels, expected 16 × 16 as the reference")) << answer.out;
  const ProgramAnswer fewer = run("grey.png grey.png --metric ms_ssim");
  EXPECT_EQ(fewer.code, 1);
  EXPECT_TRUE(contains(fewer.out, "metric ms_ssim: grey.png has 16 × 16 pixels, expected")) << fewer.out;
}

TEST_F(MetricsVerb, FiguresHaveBoundsToo) {
  EXPECT_EQ(run("black.png grey.png --metric mae --threshold mae.max=0.21").code, 0);
  const ProgramAnswer answer = run("black.png grey.png --metric mae --threshold mae.max=0.19");
  EXPECT_EQ(answer.code, 1);
  EXPECT_TRUE(contains(answer.out, "mae.max is 0.2, the threshold is 0.19 or less")) << answer.out;
  EXPECT_TRUE(contains(run("black.png grey.png --metric mae --threshold mae.mex=1").out, "mae.mex has no value"));
}

TEST_F(MetricsVerb, PixelsCountsWhatExceedsTheTolerance) {
  Rgba8Image image(16, 16, {51, 51, 51, 255});
  image(3, 4).g = 54, image(5, 5).a = 200;
  save_bytes(at("dots.png"), encode_png(image));
  const auto percent = [&](const std::string& tolerance) {
    const std::string text = run("grey.png dots.png --threshold 100 --json --metric pixels" + tolerance).out;
    return parsed_json(text)["metrics"]["pixels"];
  };
  EXPECT_DOUBLE_EQ(percent("")["value"].get<double>(), 2 * 100.0 / 256);
  EXPECT_DOUBLE_EQ(percent(":tolerance=2")["value"].get<double>(), 2 * 100.0 / 256);
  EXPECT_DOUBLE_EQ(percent(":tolerance=3")["value"].get<double>(), 100.0 / 256);
  EXPECT_DOUBLE_EQ(percent(":tolerance=55")["value"].get<double>(), 0);
  EXPECT_DOUBLE_EQ(percent("")["figures"]["pixels"].get<double>(), 2);
  EXPECT_NEAR(percent("")["figures"]["max"].get<double>(), 55, 1e-4);
}

// A render-regression test: 30 images in two folders, of which one is black, one is missing, one has another size, one
// is new and one is damaged.
class Regression : public MetricsVerb {
 protected:
  void SetUp() override {
    MetricsVerb::SetUp();
    for (int i = 0; i < 30; ++i) {
      const std::string name = (i % 3 ? "a" : "b/c") + std::string("/shot") + std::to_string(i) + ".png";
      save("golden/" + name, 100);
      if (i != 4) save("made/" + name, i == 8 ? 0 : 100, i == 12 ? 17 : 16);
    }
    save("made/b/extra & more.png", 100);
    save_bytes(at("made/a/shot1.png"), std::vector<std::uint8_t>{0x89, 'P', 'N', 'G'});
  }
};

TEST_F(Regression, EveryImageIsJudgedByItself) {
  const ProgramAnswer answer = run("golden made --metric ssim --threshold 0.95 --json --junit j.xml --report r.html");
  EXPECT_EQ(answer.code, 1);
  const auto json = parsed_json(answer.out.substr(0, answer.out.find('\n')));
  EXPECT_EQ(json["failed"], 5);
  EXPECT_EQ(json["items"].size(), 31u);
  std::map<std::string, std::string> outcomes;
  for (const auto& item : json["items"])
    if (!item["passed"]) outcomes[item["name"]] = item["outcome"];
  const std::map<std::string, std::string> expected = {{"a/shot8.png", "failed"},
                                                       {"a/shot4.png", "missing"},
                                                       {"b/c/shot12.png", "failed"},
                                                       {"b/extra & more.png", "new"},
                                                       {"a/shot1.png", "unreadable"}};
  EXPECT_EQ(outcomes, expected);
  EXPECT_EQ(json["metrics"]["ssim"]["worst_name"], "a/shot8.png");
  EXPECT_TRUE(answer.out.ends_with("\nzoneplate: 5 of 31 images failed\n")) << answer.out;

  const auto text_of_file = [&](const std::string& name) {
    const FileBytes file(at(name));
    return std::string(file.bytes().begin(), file.bytes().end());
  };
  const std::string junit = text_of_file("j.xml"), report = text_of_file("r.html");
  const std::string content = content_of_page(report);
  EXPECT_TRUE(contains(junit, "tests=\"31\" failures=\"4\" errors=\"1\"")) << junit;
  EXPECT_TRUE(contains(junit, "<testcase name=\"b/extra &amp; more.png\"")) << junit;
  EXPECT_TRUE(contains(junit, "message=\"ssim is ")) << junit;
  EXPECT_TRUE(contains(report, "<title>5 of 31 images failed</title>"));
  EXPECT_TRUE(contains(content, "{\"name\":\"a/shot8.png\",\"text\":\"ssim is "));
  EXPECT_TRUE(contains(report, "class=\"picture\" data-values=\"errors\">"));
  EXPECT_TRUE(contains(content, "\"b/extra & more.png\",\"new\""));
  // Both images of two pairs, the reference of what is missing or unreadable, and what is new.
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = report.find("data-values=\"codes\"", at)) != report.npos; ++at) ++pictures;
  EXPECT_EQ(pictures, 2u + 2 + 1 + 1 + 1);
  EXPECT_FALSE(contains(report, place.string()) || contains(content, place.string()));
  run("'" + at("golden") + "' '" + at("made") + "' --metric ssim --threshold 0.95 --report again.html -q");
  EXPECT_TRUE(contains(content, "Test images: made. References: golden."));
  EXPECT_EQ(text_of_file("again.html"), report);
  if (std::system("xmllint --version >/dev/null 2>&1") == 0) {
    const std::string schema = source_root + std::string("/tests/junit.xsd");
    EXPECT_EQ(std::system(("xmllint --noout --schema '" + schema + "' '" + at("j.xml") + "' 2>/dev/null").c_str()), 0);
  }
}

TEST_F(Regression, TheMeanAndUnpairedImagesAreOptions) {
  fs::remove(place / "made/a/shot1.png");
  fs::remove(place / "made/b/c/shot12.png");
  EXPECT_EQ(run("golden made --metric ssim --threshold 0.95 -q --allow-missing").code, 1);
  EXPECT_EQ(run("golden made --metric ssim --threshold 0.95 -q --allow-missing --aggregate mean").code, 0);
  EXPECT_EQ(run("golden made --metric ssim --threshold 0.95 -q --aggregate mean").code, 1);
  EXPECT_EQ(run("golden golden -q").out, "");
}

TEST_F(MetricsVerb, DoesNotCompareIgnoredRegions) {
  Rgba8Image image(16, 16, {51, 51, 51, 255}), mask(16, 16, {0, 0, 0, 255});
  image(3, 4) = {255, 0, 0, 255}, image(9, 9) = {0, 255, 0, 255}, mask(9, 9) = {255, 255, 255, 255};
  save_bytes(at("spots.png"), encode_png(image));
  save_bytes(at("mask.png"), encode_png(mask));
  EXPECT_EQ(run("grey.png spots.png").code, 1);
  const ProgramAnswer both = run("grey.png spots.png --ignore 2,3,4,4 --ignore mask.png");
  EXPECT_EQ(both.code, 0) << both.out;
  EXPECT_TRUE(contains(both.out, "identical") && contains(both.out, "ignored: 2,3,4,4, mask.png")) << both.out;
  const ProgramAnswer one = run("grey.png spots.png --ignore 2,3,4,4 --metric pixels --json");
  EXPECT_EQ(one.code, 1);
  EXPECT_EQ(parsed_json(one.out.substr(0, one.out.find('\n')))["metrics"]["pixels"]["figures"]["pixels"], 1);
  // NaN there is no failure.
  const auto save_pfm = [&](const std::string& name, float first) {
    std::ofstream file(at(name), std::ios::binary);
    file << "Pf\n16 16\n-1.0\n";
    for (int i = 0; i < 256; ++i) {
      const float value = i == 0 ? first : 0.5f;  // the lowest row is the first
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
  };
  save_pfm("finite.pfm", 0.5f), save_pfm("nan.pfm", NAN);
  EXPECT_EQ(run("finite.pfm nan.pfm --metric mae --threshold 1").code, 1);
  EXPECT_EQ(run("finite.pfm nan.pfm --metric mae --threshold 0 --ignore 0,15,1,1").code, 0);
  // A region that is no region is an error, and so is one that leaves nothing.
  EXPECT_EQ(run("grey.png spots.png --ignore 1,2,3").code, 2);
  EXPECT_EQ(run("grey.png spots.png --ignore masc.png").code, 3);
  const ProgramAnswer all = run("grey.png spots.png --ignore 0,0,99,99");
  EXPECT_TRUE(all.code != 0 && contains(all.out, "all pixels are ignored")) << all.out;
  const ProgramAnswer edge = run("grey.png spots.png --ignore 2,3,4,4 --metric edge_response");
  EXPECT_TRUE(edge.code != 0 && contains(edge.out, "has ignored regions, expected a whole image")) << edge.out;
}

TEST_F(MetricsVerb, TheMapLiesOverItsReference) {
  save("white.png", 255);
  EXPECT_EQ(run("grey.png grey.png --metric mae --map map.png --map-gain 2").code, 0);
  const PngImage same = decode_png(FileBytes(at("map.png")).bytes(), "map.png");
  EXPECT_EQ(same.pixels(3, 3).r, 64 + 25);  // the reference in grey
  EXPECT_EQ(run("black.png grey.png --metric mae --map map.png --map-gain 2").code, 1);
  const PngImage off = decode_png(FileBytes(at("map.png")).bytes(), "map.png");
  EXPECT_EQ(off.pixels(3, 3), metrics::magma(0.4f));
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
}  // namespace zoneplate
