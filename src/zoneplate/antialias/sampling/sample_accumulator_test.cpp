// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/sampling/sample_accumulator.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/sampling/accumulate.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"

namespace zoneplate::antialias {
namespace {

constexpr Linear grey(float v) { return {v, v, v, 1}; }

/// A frame in which all pixels have the same samples.
Frame frame_of(const std::vector<Linear>& samples, int side = 7) {
  Frame frame;
  for (const Linear& c : samples) frame.sample_color.emplace_back(side, side, c);
  return frame;
}

SampleAccumulator accumulated(ResolveFilter filter, const Frame& frame, const SamplePattern& pattern) {
  SampleAccumulator accumulator(std::move(filter));
  accumulator.add(frame, pattern);
  return accumulator;
}

const SamplePattern two = {{64, 128}, {192, 128}};

TEST(SampleAccumulator, ResolvesAreWhatTheyAreByHand) {
  const Frame frame = frame_of({grey(0), grey(1)});
  EXPECT_FLOAT_EQ(accumulated({}, frame, two).light()(3, 3).g, 0.5f);
  // Karis: weights 1 and ½. Max3: the mean of 0 and ½ is ¼, and the inverse mapping gives ¼ / ¾.
  EXPECT_FLOAT_EQ(accumulated({.weight = SampleWeight::Karis}, frame, two).light()(3, 3).g, 1 / 3.0f);
  EXPECT_FLOAT_EQ(accumulated({.weight = SampleWeight::Max3}, frame, two).light()(3, 3).g, 1 / 3.0f);
  // A colour of one channel: Max3 depends on the greatest channel, Karis on luma.
  const Frame blue = frame_of({grey(0), Linear{0, 0, 1, 1}});
  EXPECT_FLOAT_EQ(accumulated({.weight = SampleWeight::Max3}, blue, two).light()(3, 3).b, 1 / 3.0f);
  EXPECT_NEAR(accumulated({.weight = SampleWeight::Karis}, blue, two).light()(3, 3).b, 1 / (2 + 0.0722), 1e-6);
}

TEST(SampleAccumulator, WhatIsShownIsAveragedAsItIsShown) {
  for (const float sun : {1.0f, 100.0f}) {
    Frame frame = frame_of({grey(0), grey(sun)});
    const SampleAccumulator accumulator = accumulated({.weight = SampleWeight::Display}, frame, two);
    const DisplayImage image = accumulator.display_referred(DisplayImage(7, 7), frame.display);
    EXPECT_NEAR(image(3, 3).g, encode_srgb(0.5f), 1e-6) << sun;
    EXPECT_EQ(image(3, 3).a, 1);
  }
  // Half a pixel of transparency over a background: blended with the background's light. In a transparent image: alpha
  // ½, with its own colour.
  Frame frame = frame_of({grey(1), Linear{0, 0, 0, 0}});
  frame.display.background = {0, 0, 0, 1};
  EXPECT_NEAR(accumulated({.weight = SampleWeight::Display}, frame, two)
                  .display_referred(DisplayImage(7, 7), frame.display)(3, 3)
                  .g,
              encode_srgb(0.5f), 1e-6);
  frame.display.is_transparent = true;
  const Display half = accumulated({.weight = SampleWeight::Display}, frame, two)
                           .display_referred(DisplayImage(7, 7), frame.display)(3, 3);
  EXPECT_NEAR(half.g, 1, 1e-6);
  EXPECT_NEAR(half.a, 0.5, 1e-6);
}

TEST(SampleAccumulator, EncodedValuesAreAveragedAfterToneMapping) {
  const auto mean = [](const Frame& frame) {
    return accumulated({.weight = SampleWeight::Encoded}, frame, two)
        .display_referred(DisplayImage(7, 7), frame.display)(3, 3);
  };
  for (const float sun : {1.0f, 100.0f})
    EXPECT_EQ(mean(frame_of({grey(0), grey(sun)})), (Display{0.5f, 0.5f, 0.5f, 1}));
  // Over a background: its encoded value is averaged; in a transparent image: premultiplied values are.
  Frame frame = frame_of({grey(1), Linear{0, 0, 0, 0}});
  frame.display.background = {0.2f, 0.4f, 0, 1};
  EXPECT_EQ(mean(frame), (Display{0.6f, 0.7f, 0.5f, 1}));
  frame.display.is_transparent = true;
  EXPECT_EQ(mean(frame), (Display{1, 1, 1, 0.5f}));
}

TEST(SampleAccumulator, AConstantStaysOne) {
  for (const SampleWeight weight : {SampleWeight::Even, SampleWeight::Karis, SampleWeight::Max3})
    for (const std::string_view name : filter_names) {
      ResolveFilter filter{.weight = weight, .kernel = {}};
      if (name != "pixel") filter.kernel = make_kernel(name);
      const Frame frame = frame_of({{0.25f, 3, 0.5f, 1}, {0.25f, 3, 0.5f, 1}});
      const LinearImage image = accumulated(filter, frame, two).light();
      for (const Linear& c : image.values()) {
        ASSERT_NEAR(c.r, 0.25f, 2e-6f) << name;
        ASSERT_NEAR(c.g, 3, 2e-5f) << name;
        ASSERT_NEAR(c.a, 1, 2e-6f) << name;
      }
    }
}

TEST(SampleAccumulator, FiltersReachAsFarAsTheirRadius) {
  Frame frame = frame_of({Linear{0, 0, 0, 0}}, 9);
  frame.sample_color[0](4, 4) = grey(1);
  const SamplePattern centre = {SamplePosition{}};
  // A tent of radius 2 at distances of 0 and 1 pixels: 1 and ½ of a sum of 2 in each direction.
  ResolveFilter wide{.weight = {}, .kernel = stretched(make_kernel("tent"), 2 / make_kernel("tent").radius)};
  EXPECT_EQ(wide.radius(), 2);
  const LinearImage image = accumulated(wide, frame, centre).light();
  EXPECT_FLOAT_EQ(image(4, 4).g, 0.25f);
  EXPECT_FLOAT_EQ(image(5, 4).g, 0.125f);
  EXPECT_FLOAT_EQ(image(3, 5).g, 0.0625f);
  EXPECT_FLOAT_EQ(image(6, 4).g, 0);
  // A sample at the pixel's right side is closer to the right neighbour.
  const LinearImage right = accumulated(wide, frame, {{224, 128}}).light();
  EXPECT_GT(right(5, 4).g, right(3, 4).g);
  EXPECT_GT(right(4, 4).g, right(5, 4).g);
}

TEST(SampleAccumulator, RoundsAddUpAndThreadsLeaveNoTrace) {
  Frame frame = frame_of({grey(0), grey(1)}, 40);
  for (int i = 0; i < 40; ++i) frame.sample_color[0](i, i) = grey(5);
  const ResolveFilter mitchell{.weight = SampleWeight::Karis, .kernel = make_kernel("mitchell")};
  SampleAccumulator rounds(mitchell);
  for (std::size_t s = 0; s < 2; ++s) {
    Frame one;
    one.sample_color.push_back(frame.sample_color[s]);
    rounds.add(one, std::span(two).subspan(s, 1));
  }
  LinearImage many;
  with_threads(3, [&] { many = accumulated(mitchell, frame, two).light(); });
  EXPECT_EQ(rounds.light(), many);
}

/// The results of every kernel of the set on rows of n pixels, concatenated.
std::vector<float> kernel_results(const AccumulateKernels& kernels, std::size_t n) {
  std::vector<float> color(4 * (n + 12)), weight(n + 12), out;
  for (std::size_t i = 0; i < 4 * n; ++i) color[8 + i] = unit_float(hash(static_cast<std::uint32_t>(i), 7)) * 3 - 0.5f;
  const auto keep = [&](const std::vector<float>& v, std::size_t first, std::size_t count) {
    out.insert(out.end(), v.begin() + static_cast<std::ptrdiff_t>(first),
               v.begin() + static_cast<std::ptrdiff_t>(first + count));
  };
  kernels.weigh_karis(1.7f, color.data() + 8, weight.data() + 2, n);
  keep(color, 8, 4 * n), keep(weight, 2, n);
  std::fill(weight.begin() + static_cast<std::ptrdiff_t>(n) + 2, weight.end(), 0.0f);
  kernels.premultiply(color.data() + 8, n);
  kernels.map_max3(color.data() + 8, n);
  keep(color, 8, 4 * n);
  const float across[] = {-0.25f, 0.7f, 1.1f, 0.6f, -0.125f}, down[] = {0.3f, -0.9f, 0.25f};
  std::vector<float> sum[3];
  float* rows[3];
  for (int k = 0; k < 3; ++k) sum[k].assign(4 * (n + 8), 0.5f), rows[k] = sum[k].data();
  kernels.spread(color.data(), 4, across, 5, down, rows, 3, 4 * n);
  std::vector<float> weights(n + 8, 0.5f);
  float* const weight_rows[] = {weights.data()};
  kernels.spread(weight.data(), 1, across, 5, down, weight_rows, 1, n);
  keep(weights, 0, n);
  for (const std::vector<float>& row : sum) keep(row, 0, 4 * n);
  for (const bool is_max3 : {false, true}) {
    std::vector<float> mean(4 * n);
    kernels.mean(sum[0].data(), sum[1].data(), is_max3, mean.data(), n);
    keep(mean, 0, 4 * n);
  }
  return out;
}

TEST(SampleAccumulator, KernelsGiveTheScalarTwinsBits) {
  for (const Isa isa : supported_isas())
    for (const std::size_t n : {1u, 2u, 7u, 8u, 9u, 31u, 64u})
      EXPECT_EQ(kernel_results(AccumulateKernels::of(isa), n), kernel_results(AccumulateKernels::scalar, n))
          << name_of(isa) << ", " << n;
}

TEST(SampleAccumulator, IsTheSumOfAllProducts) {
  // Compared with the definition, pixel by pixel, on an image narrower than the filter and on one that is cut into
  // several parts.
  for (const int side : {3, 70}) {
    Frame frame = frame_of({grey(0), grey(0)}, side);
    for (std::uint32_t s = 0; s < 2; ++s)
      for (std::uint32_t i = 0; i < frame.sample_color[s].values().size(); ++i)
        for (float* v : {&frame.sample_color[s].values()[i].r, &frame.sample_color[s].values()[i].a})
          *v = unit_float(hash(i, s));
    const Kernel kernel = make_kernel("catmull-rom");
    const LinearImage image = accumulated({.weight = SampleWeight::Karis, .kernel = kernel}, frame, two).light();
    for (int y = 0; y < side; y += 1 + side / 9)
      for (int x = 0; x < side; ++x) {
        double red = 0, weight = 0;
        for (std::size_t s = 0; s < 2; ++s)
          for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
              const Linear c = frame.sample_color[s](i, j);
              const double w = kernel.value(i - x + two[s].x / 256.0 - 0.5) *
                               kernel.value(j - y + two[s].y / 256.0 - 0.5) /
                               (1 + 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b);
              red += w * c.r, weight += w;
            }
        ASSERT_NEAR(image(x, y).r, red / weight, 2e-6) << side << " at " << x << "," << y;
      }
  }
}

}  // namespace
}  // namespace zoneplate::antialias
