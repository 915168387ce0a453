// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/cli/signal/signal_for_test.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate::cli {
namespace {

using SignalSpectrum = SignalVerb;

TEST_F(SignalSpectrum, FindsTheWaveOfASine) {
  // 32 of 128 bins in x, 16 in y: the frequency √5/16 at the angle atan(1/2).
  const double angle = std::atan(0.5) * 180 / M_PI, frequency = std::sqrt(5.0) / 16;
  const auto spec = "sine:size=128,frequency=" + std::to_string(2 * frequency) + ",angle=" + std::to_string(angle);
  for (const Words& window : {Words{}, Words{"--window", "hann"}, Words{"--periodic"}}) {
    Words words{spec};
    words.insert(words.end(), window.begin(), window.end());
    const auto json = SignalVerb::json(run_signal_spectrum, words);
    EXPECT_NEAR(json["strongest"]["fx"].get<double>(), 0.25, 1e-9);
    EXPECT_NEAR(json["strongest"]["fy"].get<double>(), 0.125, 1e-9);
    // The smooth part contains a little of a wave with a fractional number of periods.
    EXPECT_NEAR(json["strongest"]["amplitude"].get<double>(), 0.5, window == Words{"--periodic"} ? 0.01 : 1e-4);
    EXPECT_NEAR(json["strongest"]["degrees"].get<double>(), angle, 1e-6);
  }
  const auto plain = json(run_signal_spectrum, {spec});
  EXPECT_EQ(plain["format"], "zoneplate-signal");
  EXPECT_EQ(plain["version"], report_version);
  EXPECT_NEAR(plain["mean"].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(plain["standard_deviation"].get<double>(), std::sqrt(0.125), 1e-5);
  EXPECT_NEAR(plain["variance_shares"]["to_1_2"].get<double>(), 1, 1e-4);
}

TEST_F(SignalSpectrum, DrawsAWaveAsTwoPointsAroundTheMiddle) {
  out(run_signal_spectrum, {"sine:size=64,frequency=0.25", "-o", at("s.png")});
  const Rgba8Image image = picture("s.png");
  ASSERT_EQ(image.width(), 64);
  const Rgba8 palest = metrics::magma(1), black = metrics::magma(0);
  EXPECT_EQ(image(32 + 16, 32), palest);
  EXPECT_EQ(image(32 - 16, 32), palest);
  EXPECT_EQ(image(32, 32), palest);  // the mean
  EXPECT_EQ(image(32, 32 + 16), black);
  EXPECT_EQ(image(10, 50), black);
}

TEST_F(SignalSpectrum, ShowsPhaseInARingOfColours) {
  // An impulse in the middle of an even size: the phase is π (kx + ky), alternately white and black.
  out(run_signal_spectrum, {"impulse:size=16", "--phase", "-o", at("p.png")});
  const Rgba8Image image = picture("p.png");
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) EXPECT_EQ(image(x, y).r > 128, (x + y) % 2 == 0) << x << ' ' << y;
}

TEST_F(SignalSpectrum, TheRadialProfileOfNoiseIsFlat) {
  const auto json = SignalVerb::json(run_signal_spectrum, {"noise:size=128", "--radial"});
  const auto power = json["radial"]["power"].get<std::vector<double>>();
  ASSERT_EQ(power.size(), json["radial"]["frequency"].size());
  // White noise of variance 1/12 has a power of 1/12 over the number of pixels in every bin.
  for (std::size_t i = 8; i < 60; ++i) EXPECT_NEAR(power[i] * 12 * 128 * 128, 1, 0.35) << i;
  EXPECT_TRUE(contains(out(run_signal_spectrum, {"noise:size=32", "--radial"}), "frequency"));
}

TEST_F(SignalSpectrum, WritesThePlotAndTheFigure) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  out(run_signal_spectrum, {"noise:size=64", "--radial", "-o", at("r.svg")});
  EXPECT_TRUE(contains(text("r.svg"), "frequency (cycles per pixel)"));
  out(run_signal_spectrum, {"zone-plate:size=64", "--side-by-side", "-o", at("f.png")});
  EXPECT_GT(picture("f.png").width(), 2 * 512);
}

TEST_F(SignalSpectrum, TheSameBytesOnAnyNumberOfThreads) {
  const auto bytes = [&](const char* threads) {
    std::string all;
    for (const char* what : {"--phase", "--periodic", "--codes"}) {
      out(run_signal_spectrum, {"bricks:size=150", what, "-t", threads, "-o", at("t.png")});
      all += text("t.png");
    }
    return all + out(run_signal_spectrum, {"bricks:size=150", "--radial", "--json", "-t", threads});
  };
  EXPECT_EQ(bytes("1"), bytes("2"));
  EXPECT_EQ(bytes("1"), bytes("7"));
}

TEST_F(SignalSpectrum, TheSmallestImages) {
  save_bytes(at("one.png"), encode_png(Rgba8Image(1, 1, {255, 255, 255, 255})));
  save_bytes(at("row.png"), encode_png(Rgba8Image(5, 1, {255, 255, 255, 255})));
  for (const char* name : {"one.png", "row.png"}) {
    const auto json = SignalVerb::json(run_signal_spectrum, {at(name), "--radial"});
    EXPECT_NEAR(json["mean"].get<double>(), 1, 1e-6) << name;
    EXPECT_NEAR(json["strongest"]["amplitude"].get<double>(), 0, 1e-12) << name;
    out(run_signal_spectrum, {at(name), "-o", at("s.png")});
    EXPECT_EQ(picture("s.png")(picture("s.png").width() / 2, 0), metrics::magma(1)) << name;
  }
}

TEST_F(SignalSpectrum, RefusesWhatMakesNoSense) {
  EXPECT_TRUE(contains(refusal(run_signal_spectrum, {}), "requires one IMAGE"));
  EXPECT_TRUE(contains(refusal(run_signal_spectrum, {"noise", "--window", "hat"}), "--window: "));
  EXPECT_TRUE(
      contains(refusal(run_signal_spectrum, {"noise", "--window", "hann", "--periodic"}), "cannot be combined"));
  EXPECT_TRUE(contains(refusal(run_signal_spectrum, {"noise", "-o", "x.jpg"}), "ends in .png"));
  EXPECT_TRUE(contains(refusal(run_signal_spectrum, {"noise:size=0"}), "size"));
  refusal(run_signal_spectrum, {at("missing.png")}, ErrorKind::Input);
  refusal(run_signal_spectrum, {"noise:size=8", "-o", at("no/such/folder/x.png")}, ErrorKind::Output);
}

TEST_F(SignalSpectrum, SubcommandsAreFoundAndMisspeltOnesNamed) {
  EXPECT_TRUE(contains(out(run_signal, {"spectrum", "noise:size=8"}), "noise:size=8, 8 × 8"));
  EXPECT_TRUE(contains(refusal(run_signal, {"spectrun"}), "did you mean spectrum?"));
  for (const Words& words : {Words{}, Words{"--help"}, Words{"-h"}})
    EXPECT_TRUE(contains(out(run_signal, words), "zoneplate signal SUBCOMMAND"));
  for (const char* name : {"spectrum", "filter", "convolve", "resample", "decimate", "series", "sample", "box"}) {
    const std::string help = out(run_signal, {name, "--help"});
    EXPECT_TRUE(contains(help, "Examples:")) << name;
    EXPECT_TRUE(contains(help, "--json")) << name;
    EXPECT_TRUE(contains(out(run_signal, {}), name));
  }
}

}  // namespace
}  // namespace zoneplate::cli
