// SPDX-License-Identifier: Apache-2.0
// Tests of the subcommands that draw plots from numbers alone: series, sample, box.
#include "zoneplate/signal/fourier/series.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/cli/signal/signal_for_test.h"

namespace zoneplate::cli {
namespace {

using SignalSeries = SignalVerb;

TEST_F(SignalSeries, OvershootsByGibbs) {
  const auto found = json(run_signal_series, {"square", "--terms", "1,101,999"});
  ASSERT_EQ(found["sums"].size(), 3u);
  EXPECT_NEAR(found["sums"][0]["greatest"].get<double>(), 4 / M_PI, 1e-5);
  EXPECT_NEAR(found["sums"][0]["missing_rms"].get<double>(), std::sqrt(1 - 8 / (M_PI * M_PI)), 1e-9);
  for (const std::size_t i : {1u, 2u}) EXPECT_NEAR(found["sums"][i]["overshoot_of_jump"].get<double>(), 0.08949, 1e-4);
  // The sum is greatest at the reported position.
  for (const auto& [name, wave] :
       {std::pair{"square", Wave::Square}, {"sawtooth", Wave::Sawtooth}, {"triangle", Wave::Triangle}})
    for (const int highest : {1, 4, 9}) {
      double greatest = 0;
      for (int i = 0; i < 5000; ++i) greatest = std::max(greatest, partial_sum(wave, highest, i / 5000.0));
      const auto sums = json(run_signal_series, {name, "--terms", std::to_string(highest)})["sums"];
      EXPECT_NEAR(sums[0]["greatest"].get<double>(), greatest, 1e-4) << name << highest;
    }
  EXPECT_EQ(found["harmonics"].size(), 999u);
  EXPECT_EQ(found["harmonics"][1], 0);
  EXPECT_TRUE(json(run_signal_series, {"triangle"})["sums"][3]["overshoot_of_jump"].is_null());
  EXPECT_NEAR(json(run_signal_series, {"sawtooth", "--terms", "9999"})["sums"][0]["missing_rms"].get<double>(), 0.0045,
              1e-4);
  EXPECT_TRUE(contains(out(run_signal_series, {"square"}), "Gibbs"));
}

TEST_F(SignalSeries, DrawsSvgAndPng) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  out(run_signal_series, {"square", "-o", at("s.svg")});
  EXPECT_TRUE(contains(text("s.svg"), "harmonics to 15"));
  EXPECT_TRUE(contains(text("s.svg"), "frequency (cycles per period)"));
  out(run_signal_series, {"sawtooth", "-o", at("s.png")});
  EXPECT_EQ(picture("s.png").width(), 2 * 720);
}

TEST_F(SignalSeries, Refuses) {
  EXPECT_TRUE(contains(refusal(run_signal_series, {"sine"}), "expected square, sawtooth or triangle"));
  EXPECT_TRUE(contains(refusal(run_signal_series, {}), "requires a wave"));
  EXPECT_TRUE(contains(refusal(run_signal_series, {"square", "--terms", "0"}), "--terms: "));
  EXPECT_TRUE(contains(refusal(run_signal_series, {"square", "--terms", ""}), "--terms"));
  EXPECT_TRUE(contains(refusal(run_signal_series, {"square", "-o", "x.pdf"}), ".svg or .png"));
}

using SignalSample = SignalVerb;

TEST_F(SignalSample, NamesTheAlias) {
  const auto alias = json(run_signal_sample, {"--frequency", "7", "--rate", "10"});
  EXPECT_EQ(alias["is_aliased"], true);
  EXPECT_EQ(alias["apparent"], -3);
  EXPECT_EQ(alias["same_samples"], (std::vector<double>{3, 13, 17, 23, 27, 33}));
  EXPECT_EQ(alias["overlap"]["low"], 3);
  EXPECT_EQ(alias["overlap"]["high"], 7);
  const auto fine = json(run_signal_sample, {"--frequency", "3", "--rate", "10"});
  EXPECT_EQ(fine["is_aliased"], false);
  EXPECT_TRUE(fine["overlap"].is_null());
  EXPECT_TRUE(
      contains(out(run_signal_sample, {"--frequency", "0.9", "--rate", "1"}), "those of 0.1 Hz, running backwards"));
}

TEST_F(SignalSample, DrawsWavesAndCopies) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  out(run_signal_sample, {"--frequency", "7", "--rate", "10", "-o", at("a.svg")});
  EXPECT_TRUE(contains(text("a.svg"), "samples of both"));
  EXPECT_TRUE(contains(text("a.svg"), "where they overlap"));
  out(run_signal_sample, {"--frequency", "3", "--rate", "10", "-o", at("b.svg")});
  EXPECT_FALSE(contains(text("b.svg"), "where they overlap"));
}

TEST_F(SignalSample, Refuses) {
  EXPECT_TRUE(contains(refusal(run_signal_sample, {"--frequency", "7"}), "--frequency and --rate"));
  EXPECT_TRUE(contains(refusal(run_signal_sample, {"--frequency", "7", "--rate", "0"}), "--rate: "));
  EXPECT_TRUE(contains(refusal(run_signal_sample, {"--frequency", "7000", "--rate", "1"}), "1000 times"));
  EXPECT_TRUE(contains(refusal(run_signal_sample, {"x", "--frequency", "7", "--rate", "10"}), "no operands"));
}

using SignalBox = SignalVerb;

TEST_F(SignalBox, WidthTimesFirstZeroIsOne) {
  const auto found = json(run_signal_box, {"--widths", "2,5"});
  for (const auto& box : found["boxes"]) {
    const double width = box["width"], half = box["half_power"];
    EXPECT_NEAR(width * box["first_zero"].get<double>(), 1, 1e-12);
    const double sinc = std::sin(M_PI * width * half) / (M_PI * width * half);
    EXPECT_NEAR(sinc * sinc, 0.5, 1e-5);
  }
  EXPECT_NEAR(found["boxes"][0]["response_at_nyquist"].get<double>(), 0, 1e-12);
  EXPECT_TRUE(contains(out(run_signal_box, {}), "first zero"));
}

TEST_F(SignalBox, DrawsAndRefuses) {
  EXPECT_TRUE(contains(refusal(run_signal_box, {"--widths", "3,,5"}), "--widths: "));
  EXPECT_TRUE(contains(refusal(run_signal_box, {"3"}), "no operands"));
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  out(run_signal_box, {"-o", at("b.svg")});
  EXPECT_TRUE(contains(text("b.svg"), "15 pixels wide"));
}

}  // namespace
}  // namespace zoneplate::cli
