// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/cli/signal/signal_for_test.h"
#include "zoneplate/imaging/signal/load.h"

namespace zoneplate::cli {
namespace {

using SignalResample = SignalVerb;

TEST_F(SignalResample, TakesSizesAndFactors) {
  for (const auto& [size, width, height] : {std::tuple{"20x10", 20, 10},
                                            {"20,10", 20, 10},
                                            {"0.5", 16, 16},
                                            {"50%", 16, 16},
                                            {"2", 64, 64},
                                            {"0.01", 1, 1}}) {
    out(run_signal_resample, {"bricks:size=32", "--size", size, "-o", at("r.png")});
    EXPECT_EQ(picture("r.png").width(), width) << size;
    EXPECT_EQ(picture("r.png").height(), height) << size;
  }
}

TEST_F(SignalResample, MixesLightUnlessTold) {
  // The mean of 0.05 and 0.8 in linear light is 0.425, code 174. The mean of codes 63 and 231 is 147.
  const Words words{"checkerboard:size=32,cell=1", "--size", "0.5", "--kernel", "box", "-o", at("r.png")};
  out(run_signal_resample, words);
  const Rgba8Image light = picture("r.png");
  for (const Rgba8& c : light.values()) EXPECT_EQ(c, (Rgba8{174, 174, 174, 255}));
  Words codes = words;
  codes.emplace_back("--codes");
  out(run_signal_resample, codes);
  const Rgba8Image mixed = picture("r.png");
  for (const Rgba8& c : mixed.values()) EXPECT_EQ(c.r, 147);
}

TEST_F(SignalResample, NearestPicksAndIdealKeepsWaves) {
  out(run_signal_resample, {"checkerboard:size=32,cell=4", "--size", "2", "--kernel", "nearest", "-o", at("n.png")});
  out(run_signal_resample, {"checkerboard:size=64,cell=8", "--size", "1", "--kernel", "nearest", "-o", at("m.png")});
  EXPECT_EQ(picture("n.png"), picture("m.png"));
  // A wave of period 8, enlarged twice, has period 16; half a pixel of the old grid becomes a shift of a quarter.
  out(run_signal_resample, {"sine:size=32,frequency=0.125", "--size", "2", "--kernel", "ideal", "-o", at("i.png")});
  const Rgba8Image wave = picture("i.png");
  const auto light = [](int x) { return 0.5 + 0.5 * std::cos(2 * M_PI * ((x + 0.5) / 2 - 0.5) / 8); };
  const auto code = [](double v) { return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055); };
  for (int x = 0; x < 64; ++x) EXPECT_NEAR(wave(x, 7).r, code(light(x)), 0.51 + 1e-3) << x;
}

TEST_F(SignalResample, KeepsTransparencyPremultiplied) {
  // Transparent red next to opaque green: the mean is green with half coverage.
  Rgba8Image image(2, 2, {0, 255, 0, 255});
  image(0, 0) = image(0, 1) = {255, 0, 0, 0};
  save_bytes(at("a.png"), encode_png(image));
  out(run_signal_resample, {at("a.png"), "--size", "1x1", "--kernel", "box", "-o", at("b.png")});
  EXPECT_EQ(picture("b.png")(0, 0), (Rgba8{0, 255, 0, 128}));
}

TEST_F(SignalResample, BordersAreCutAsPillowDoes) {
  // Enlarges the row 0 64 128 255 in grey from 4 pixels to 8, compared with Pillow's resize(BILINEAR) and (LANCZOS) of
  // an "F" image: the tent's weights are 1 at the border; elsewhere 3/4 and 1/4.
  Rgba8Image row(4, 1);
  for (int x = 0; x < 4; ++x) {
    constexpr std::uint8_t codes[] = {0, 64, 128, 255};
    row(x, 0) = {codes[x], codes[x], codes[x], 255};
  }
  save_bytes(at("row.png"), encode_png(row));
  out(run_signal_resample,
      {at("row.png"), "--size", "8x1", "--kernel", "tent", "--codes", "--border", "cut", "-o", at("cut.pfm")});
  const LinearImage cut = load_signal(at("cut.pfm"), false);
  const double bilinear[] = {0, 16, 48, 80, 112, 159.75, 223.25, 255};
  for (int x = 0; x < 8; ++x) EXPECT_NEAR(255.0 * static_cast<double>(cut(x, 0).r), bilinear[x], 1e-3) << x;
  // The five or six taps of lanczos3 inside the image are divided by their sum; outside there are none, as if repeated.
  for (const char* border : {"cut", "clamp"})
    out(run_signal_resample, {at("row.png"), "--size", "8x1", "--kernel", "lanczos3", "--codes", "--border", border,
                              "-o", at(border + std::string(".pfm"))});
  const LinearImage lanczos = load_signal(at("cut.pfm"), false), clamped = load_signal(at("clamp.pfm"), false);
  const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x); };
  const double codes[] = {0, 64, 128, 255};
  for (int x = 0; x < 8; ++x) {
    double sum = 0, weights = 0;
    for (int i = 0; i < 4; ++i) {
      const double away = i - ((x + 0.5) / 2 - 0.5), weight = std::abs(away) < 3 ? sinc(away) * sinc(away / 3) : 0;
      sum += weight * codes[i], weights += weight;
    }
    EXPECT_NEAR(255.0 * static_cast<double>(lanczos(x, 0).r), sum / weights, 1e-2) << x;
  }
  EXPECT_NE(lanczos(0, 0).r, clamped(0, 0).r);
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "--border", "cut"}), "cannot be used here"));
}

TEST_F(SignalResample, BeyondTheBorderZeroIsBlackAndNotTransparent) {
  save_bytes(at("white.png"), encode_png(Rgba8Image(8, 8, {255, 255, 255, 255})));
  out(run_signal_resample,
      {at("white.png"), "--size", "16x16", "--kernel", "tent", "--border", "zero", "--codes", "-o", at("z.png")});
  EXPECT_EQ(picture("z.png")(0, 8), (Rgba8{191, 191, 191, 255}));
}

TEST_F(SignalResample, ShowsBothAndRefuses) {
  out(run_signal_resample, {"bricks:size=64", "--size", "0.4", "--side-by-side", "-o", at("f.png")});
  EXPECT_GT(picture("f.png").width(), 1000);
  EXPECT_TRUE(contains(refusal(run_signal_resample, {"noise", "-o", at("r.png")}), "--size is missing"));
  EXPECT_TRUE(contains(refusal(run_signal_resample, {"noise", "--size", "2"}), "--output is missing"));
  EXPECT_TRUE(contains(refusal(run_signal_resample, {"noise", "--size", "0", "-o", at("r.png")}), "expected 1 to"));
  EXPECT_TRUE(
      contains(refusal(run_signal_resample, {"noise", "--size", "1000000", "-o", at("r.png")}), "expected 1 to"));
  EXPECT_TRUE(contains(refusal(run_signal_resample, {"noise", "--size", "half", "-o", at("r.png")}), "not a number"));
  EXPECT_TRUE(contains(refusal(run_signal_resample, {"noise", "--kernel", "blob"}), "--kernel: "));
}

TEST_F(SignalResample, ReadsAndWritesPipes) {
  out(run_signal_resample, {"bricks:size=32", "--size", "1", "--kernel", "nearest", "-o", at("in.png")});
  const std::string command = "'" + std::string(program_file) + "' signal resample - --size 0.5 --json -o - < '" +
                              at("in.png") + "' > '" + at("piped.png") + "' 2> '" + at("numbers.json") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  out(run_signal_resample, {at("in.png"), "--size", "0.5", "-o", at("plain.png")});
  EXPECT_EQ(text("piped.png"), text("plain.png"));
  EXPECT_EQ(parsed_json(text("numbers.json"))["width"], 16);
}

using SignalDecimate = SignalVerb;

TEST_F(SignalDecimate, MeasuresTheAcceptedFigures) {
  for (const auto& [image, by] : {std::pair{"zone-plate:size=256", "2"}, {"zone-plate:size=370", "3.7"}}) {
    const auto found = json(run_signal_decimate, {image, "--by", by});
    const auto& lanczos = found["kernels"]["lanczos3"];
    EXPECT_LE(lanczos["measured"]["all_db"].get<double>(), -15);
    EXPECT_LE(lanczos["measured"]["far_db"].get<double>(), -40);
    EXPECT_NEAR(lanczos["measured"]["all_db"].get<double>(), lanczos["expected"]["all_db"].get<double>(), 1);
  }
  const auto all = json(run_signal_decimate, {"zone-plate:size=64", "--all-kernels"});
  EXPECT_EQ(all["kernels"].size(), 11u);
}

TEST_F(SignalDecimate, DroppingPixelsTurnsAFineWaveIntoACoarseOne) {
  // A wave of 0.4375 cycles per pixel at every second pixel: 0.875 is aliased to 0.125 cycles per pixel, a period of 8
  // pixels at full contrast; filtered it is grey.
  out(run_signal_decimate,
      {"sine:size=64,frequency=0.4375", "--naive", at("n.png"), "--filtered", at("f.png"), "-o", at("both.png")});
  const Rgba8Image naive = picture("n.png"), filtered = picture("f.png");
  ASSERT_EQ(naive.width(), 32);
  int low = 255, high = 0;
  for (int x = 0; x + 8 < 32; ++x) {
    EXPECT_NEAR(naive(x, 3).r, naive(x + 8, 3).r, 2);
    low = std::min<int>(low, naive(x, 3).r), high = std::max<int>(high, naive(x, 3).r);
  }
  EXPECT_GT(high - low, 190);
  for (int x = 4; x < 28; ++x) EXPECT_NEAR(filtered(x, 3).r, 188, 6);
  EXPECT_GT(picture("both.png").width(), 1000);
}

TEST_F(SignalDecimate, Refuses) {
  EXPECT_TRUE(contains(refusal(run_signal_decimate, {"noise", "--by", "0.5"}), "--by: "));
  EXPECT_TRUE(contains(refusal(run_signal_decimate, {"noise", "--kernel", "nearest"}), "unknown kernel 'nearest'"));
  EXPECT_TRUE(contains(refusal(run_signal_decimate, {"noise", "--naive", "x.gif"}), "ends in .png"));
}

}  // namespace
}  // namespace zoneplate::cli
