// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/frequency_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Pass = FrequencyFilter::Pass;
using Kind = FilterShape::Kind;

TEST(FrequencyFilter, EveryShapeIsHalfAtItsCutOffsAndRunsFromOneToZero) {
  for (const char* text : {"ideal", "gaussian", "butterworth", "butterworth:order=7"}) {
    const FilterShape shape = parse_filter_shape(text);
    const FrequencyFilter low{Pass::Low, shape, 0, 0.1}, high{Pass::High, shape, 0.1, 0.5};
    const FrequencyFilter band{Pass::Band, shape, 0.1, 0.4}, stop{Pass::Stop, shape, 0.1, 0.4};
    EXPECT_EQ(response(low, 0), 1.0);
    EXPECT_EQ(response(high, 0), 0.0);
    EXPECT_EQ(response(band, 0), 0.0);
    EXPECT_EQ(response(stop, 0), 1.0);
    for (const FrequencyFilter& filter : {low, high, band, stop}) {
      EXPECT_NEAR(response(filter, 0.1), 0.5, shape.kind == Kind::Ideal ? 0.5 : 1e-12) << text;
      for (double f = 0; f < 0.71; f += 0.01) {
        EXPECT_GE(response(filter, f), 0.0);
        EXPECT_LE(response(filter, f), 1.0);
      }
    }
    EXPECT_NEAR(response(band, 0.2), 1, 1e-12) << "the geometric mean of the ends";
    for (double f : {0.03, 0.17, 0.4, 0.6}) {
      EXPECT_EQ(response(high, f), 1 - response(low, f));
      EXPECT_EQ(response(stop, f), 1 - response(band, f));
    }
  }
}

TEST(FrequencyFilter, ValuesByHand) {
  EXPECT_NEAR(response({Pass::Low, {Kind::Gaussian, 0}, 0, 0.1}, 0.2), 1.0 / 16, 1e-15);
  EXPECT_NEAR(response({Pass::Low, {Kind::Butterworth, 2}, 0, 0.1}, 0.2), 1.0 / 17, 1e-15);
  EXPECT_NEAR(response({Pass::High, {Kind::Butterworth, 1}, 0.1, 0}, 0.2), 4.0 / 5, 1e-15);
  EXPECT_EQ(response({Pass::Band, {Kind::Ideal, 0}, 0.1, 0.2}, 0.15), 1.0);
  EXPECT_EQ(response({Pass::Band, {Kind::Ideal, 0}, 0.1, 0.2}, 0.21), 0.0);
  EXPECT_EQ(response({Pass::Low, {Kind::Gaussian, 0}, 0, 0.001}, 0.7), 0.0);
  EXPECT_THROW(parse_filter_shape("chebyshev"), Error);
  EXPECT_THROW(parse_filter_shape("ideal:order=2"), Error);
  EXPECT_THROW(parse_filter_shape("butterworth:order=0"), Error);
}

// Waves with whole periods are eigenvectors: each is multiplied by its response.
TEST(FrequencyFilter, AWaveIsMultipliedByItsResponse) {
  const int w = 40, h = 24;
  const FrequencyFilter filter{Pass::Low, {Kind::Butterworth, 3}, 0, 0.2};
  for (const auto& [kx, ky] : {std::pair{3, 0}, {0, 5}, {7, -4}, {20, 12}}) {
    Plane<float> wave(w, h);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        wave(x, y) = static_cast<float>(std::cos(2 * M_PI * (kx * x / double{w} + ky * y / double{h})));
    const double gain = response(filter, std::hypot(kx / double{w}, ky / double{h}));
    const auto out = filtered(wave, filter);
    for (std::size_t i = 0; i < wave.values().size(); ++i)
      EXPECT_NEAR(out.values()[i], gain * static_cast<double>(wave.values()[i]), 2e-7);
  }
}

TEST(FrequencyFilter, ReflectingKeepsOppositeEdgesApart) {
  Plane<float> step(64, 8, 1.0f);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 32; ++x) step(x, y) = 0;
  const FrequencyFilter filter{Pass::Low, {Kind::Gaussian, 0}, 0, 0.05};
  EXPECT_NEAR(filtered(step, filter, Border::Wrap)(0, 4), 0.5, 0.06);
  EXPECT_NEAR(filtered(step, filter, Border::Reflect)(0, 4), 0, 1e-3);
  EXPECT_NEAR(filtered(step, filter, Border::Reflect)(63, 4), 1, 1e-3);
  EXPECT_TRUE(filtered(Plane<float>(), filter).empty());
}

TEST(FrequencyFilter, ColoursAreFilteredChannelByChannelAndThreadsDoNotMatter) {
  LinearImage image(17, 12);
  Plane<float> green(17, 12);
  for (std::uint32_t i = 0; i < 17 * 12; ++i) {
    image.values()[i] = {unit_float(hash(i)), unit_float(hash(i, 1)), unit_float(hash(i, 2)), 1};
    green.values()[i] = image.values()[i].g;
  }
  const FrequencyFilter filter{Pass::Stop, {Kind::Butterworth, 2}, 0.1, 0.3};
  const auto out = filtered(image, filter);
  const auto expected = filtered(green, filter);
  for (std::size_t i = 0; i < 17 * 12; ++i) EXPECT_EQ(out.values()[i].g, expected.values()[i]);
  for (int threads : {1, 2, 3, 7}) with_threads(threads, [&] { EXPECT_EQ(filtered(image, filter), out); });
}

}  // namespace
}  // namespace zoneplate
