// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/cli/signal/signal_for_test.h"

namespace zoneplate::cli {
namespace {

using SignalFilter = SignalVerb;

double left(const nlohmann::json& json) {
  return json["variance_after"].get<double>() / json["variance_before"].get<double>();
}

TEST_F(SignalFilter, KeepsOrTakesAWaveByItsFrequency) {
  const std::string wave = "sine:size=64,frequency=0.25";
  struct Case {
    const char *option, *value;
    double factor;
  };
  for (const Case& c :
       {Case{"--low-pass", "0.3", 1}, Case{"--low-pass", "0.2", 0}, Case{"--high-pass", "0.3", 0},
        Case{"--high-pass", "0.2", 1}, Case{"--band-pass", "0.2:0.3", 1}, Case{"--band-pass", "0.3:0.4", 0},
        Case{"--band-stop", "0.2:0.3", 0}, Case{"--band-stop", "0.3:0.4", 1}, Case{"--low-pass", "0.25", 0.25}})
    EXPECT_NEAR(left(json(run_signal_filter, {wave, "--border", "wrap", c.option, c.value})), c.factor, 1e-6)
        << c.option << c.value;
  // The response of Butterworth and Gaussian filters is one half at the cut-off frequency.
  for (const char* shape : {"gaussian", "butterworth:order=4"})
    EXPECT_NEAR(left(json(run_signal_filter, {wave, "--border", "wrap", "--low-pass", "0.25", "--shape", shape})), 0.25,
                1e-6);
}

TEST_F(SignalFilter, WritesWhatIsLeft) {
  out(run_signal_filter, {"sine:size=64,frequency=0.25", "--border", "wrap", "--low-pass", "0.1", "-o", at("low.png")});
  const Rgba8Image low = picture("low.png");
  for (const Rgba8& c : low.values()) EXPECT_EQ(c, (Rgba8{188, 188, 188, 255}));  // the mean, ½ in linear light
  // Without its mean the wave has an amplitude of ½ around mid-grey.
  out(run_signal_filter,
      {"sine:size=64,frequency=0.25", "--border", "wrap", "--high-pass", "0.1", "-o", at("high.png")});
  const Rgba8Image high = picture("high.png");
  EXPECT_EQ(high(0, 0).r, 191);
  EXPECT_EQ(high(1, 0).r, 128);
  EXPECT_EQ(high(2, 0).r, 64);
}

TEST_F(SignalFilter, ThinksInLightUnlessTold) {
  // A fine checkerboard of 0.05 and 0.8 in linear light has the mean 0.425, code 174; the mean of the codes is 149.
  const Words words{"checkerboard:size=32,cell=1", "--border", "wrap", "--low-pass", "0.1", "-o", at("mean.png")};
  out(run_signal_filter, words);
  EXPECT_EQ(picture("mean.png")(5, 5).r, 174);
  Words codes = words;
  codes.emplace_back("--codes");
  out(run_signal_filter, codes);
  EXPECT_NEAR(picture("mean.png")(5, 5).r, (63 + 231) / 2, 3);
}

TEST_F(SignalFilter, ShowsEverythingSideBySide) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  out(run_signal_filter, {"bricks:size=64", "--low-pass", "0.1", "--side-by-side", "-o", at("f.png")});
  EXPECT_GT(picture("f.png").width(), 3 * 512);
}

TEST_F(SignalFilter, WantsOneFilter) {
  EXPECT_TRUE(contains(refusal(run_signal_filter, {"noise"}), "one of --low-pass"));
  EXPECT_TRUE(
      contains(refusal(run_signal_filter, {"noise", "--low-pass", "0.1", "--high-pass", "0.2"}), "one of --low-pass"));
  EXPECT_TRUE(contains(refusal(run_signal_filter, {"noise", "--low-pass", "0"}), "--low-pass: "));
  EXPECT_TRUE(contains(refusal(run_signal_filter, {"noise", "--band-pass", "0.2"}), "LOW:HIGH"));
  EXPECT_TRUE(contains(refusal(run_signal_filter, {"noise", "--band-pass", "0.2:0.1"}), "lower frequency"));
  EXPECT_TRUE(contains(refusal(run_signal_filter, {"noise", "--low-pass", "0.1", "--border", "clamp"}),
                       "expected reflect, wrap"));
  EXPECT_TRUE(contains(refusal(run_signal_filter, {"noise", "--low-pass", "0.1", "--shape", "brick"}), "--shape: "));
}

}  // namespace
}  // namespace zoneplate::cli
