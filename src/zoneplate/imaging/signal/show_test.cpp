// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/show.h"

#include <gtest/gtest.h>

#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate {
namespace {

Spectrum spectrum_of(const char* pattern) { return fourier(luminance(make_pattern(pattern))); }

TEST(SignalShow, PanelsGrowByWholeFactorsAndShrinkToTheirSize) {
  EXPECT_EQ(fitted(Rgba8Image(512, 100)).width(), 512);
  EXPECT_EQ(fitted(Rgba8Image(300, 100)).width(), 300);
  EXPECT_EQ(fitted(Rgba8Image(100, 60)).width(), 500);
  EXPECT_EQ(fitted(Rgba8Image(100, 60)).height(), 300);
  EXPECT_EQ(fitted(Rgba8Image(1024, 512)).width(), 512);
  EXPECT_EQ(fitted(Rgba8Image(1024, 512)).height(), 256);
  EXPECT_EQ(fitted(Rgba8Image(600, 1, {10, 20, 30, 255}))(100, 0), (Rgba8{10, 20, 30, 255}));
}

TEST(SignalShow, ALineOfALargeSpectrumIsNotLost) {
  const Rgba8Image panel = magnitude_panel(spectrum_of("sine:size=520,frequency=0.25"));
  EXPECT_EQ(panel.width(), 512);
  EXPECT_EQ(panel((260 + 130) * 512 / 520, 260 * 512 / 520), metrics::magma(1));
  EXPECT_EQ(panel((260 + 66) * 512 / 520, 260 * 512 / 520), metrics::magma(0));
}

TEST(SignalShow, PhasesAreNotMixed) {
  // The central 512 of 514 bins: the mean is at the centre, as in the whole spectrum.
  const Spectrum spectrum = spectrum_of("impulse:size=514");
  const Rgba8Image whole = paint_phase(spectrum), panel = phase_panel(spectrum);
  ASSERT_EQ(panel.width(), 512);
  for (int x = 0; x < 512; ++x) EXPECT_EQ(panel(x, 256), whole(x + 1, 257));
}

TEST(SignalShow, TitlesNameFilesNotFolders) {
  EXPECT_EQ(title_of("/some/where/photo.jpg"), "photo.jpg");
  EXPECT_EQ(title_of("sine:frequency=0.2"), "sine:frequency=0.2");
  EXPECT_EQ(title_of("-"), "stdin");
  EXPECT_EQ(title_of("a\nb.png"), "a?b.png");
}

TEST(SignalShow, LevelsAreDecibelsBelowThePeak) {
  // A wave of amplitude ½ and one with a hundredth of it: 40 dB.
  Plane<float> plane = luminance(make_pattern("sine:size=64,frequency=0.25"));
  const Plane<float> weak = luminance(make_pattern("sine:size=64,frequency=0.125"));
  for (std::size_t i = 0; i < plane.values().size(); ++i) plane.values()[i] += weak.values()[i] / 100;
  const Spectrum spectrum = fourier(plane);
  EXPECT_NEAR(strongest_magnitude(spectrum), 64 * 64 / 4, 1e-2);
  const auto expect_level = [&](const MagnitudeScale& scale, int x, float level) {
    const Rgba8 found = paint_magnitude(spectrum, scale)(32 + x, 32), expected = metrics::magma(level);
    EXPECT_NEAR(found.r, expected.r, 3) << level;
    EXPECT_NEAR(found.g, expected.g, 3) << level;
  };
  expect_level({.range_db = 80}, 16, 1);
  expect_level({.range_db = 80}, 8, 0.5f);
  expect_level({.range_db = 160}, 8, 0.75f);
  // On the scale of a wave ten times as strong, all levels are 20 dB lower.
  const MagnitudeScale stronger{80, 10 * strongest_magnitude(spectrum)};
  expect_level(stronger, 16, 0.75f);
  expect_level(stronger, 8, 0.25f);
}

TEST(SignalShow, NothingIsBlackAndAConstantItsMean) {
  EXPECT_EQ(paint_magnitude(fourier(Plane<float>(4, 4)))(2, 2), metrics::magma(0));
  EXPECT_EQ(strongest_magnitude(fourier(Plane<float>(4, 4, 0.3f))), static_cast<double>(0.3f) * 16);
}

TEST(SignalShow, DifferencesLieAroundGrey) {
  EXPECT_EQ(shown_around_grey(LinearImage(1, 1, {0, 0.5f, -1, 0}))(0, 0), (Rgba8{128, 191, 0, 255}));
}

}  // namespace
}  // namespace zoneplate
