#include "zoneplate/antialias/sample_gather.h"

#include <gtest/gtest.h>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate::antialias {
namespace {

constexpr Linear grey(float v) { return {v, v, v, 1}; }

/// A frame whose samples are the same in every pixel.
Frame frame_of(const std::vector<Linear>& samples, int side = 7) {
  Frame frame;
  for (const Linear& c : samples) frame.sample_color.emplace_back(side, side, c);
  return frame;
}

SampleGather gathered(Gathering gathering, const Frame& frame, const SamplePattern& pattern) {
  SampleGather gather(std::move(gathering));
  gather.add(frame, pattern);
  return gather;
}

const SamplePattern two = {{64, 128}, {192, 128}};

TEST(SampleGather, ResolvesAreWhatTheyAreByHand) {
  const Frame frame = frame_of({grey(0), grey(1)});
  EXPECT_FLOAT_EQ(gathered({}, frame, two).light()(3, 3).g, 0.5f);
  // Weights 1 and ½; and 0 and ½ on average a quarter, mapped back ¼ / ¾.
  EXPECT_FLOAT_EQ(gathered({.weight = SampleWeight::Karis}, frame, two).light()(3, 3).g, 1 / 3.0f);
  EXPECT_FLOAT_EQ(gathered({.weight = SampleWeight::Max3}, frame, two).light()(3, 3).g, 1 / 3.0f);
  // A colour of one channel: the greatest counts, luma does not.
  const Frame blue = frame_of({grey(0), Linear{0, 0, 1, 1}});
  EXPECT_FLOAT_EQ(gathered({.weight = SampleWeight::Max3}, blue, two).light()(3, 3).b, 1 / 3.0f);
  EXPECT_NEAR(gathered({.weight = SampleWeight::Karis}, blue, two).light()(3, 3).b, 1 / (2 + 0.0722), 1e-6);
}

TEST(SampleGather, WhatIsShownIsAveragedAsItIsShown) {
  for (const float sun : {1.0f, 100.0f}) {
    Frame frame = frame_of({grey(0), grey(sun)});
    const SampleGather gather = gathered({.weight = SampleWeight::Display}, frame, two);
    const DisplayImage image = gather.shown(DisplayImage(7, 7), frame.display);
    EXPECT_NEAR(image(3, 3).g, encode_srgb(0.5f), 1e-6) << sun;
    EXPECT_EQ(image(3, 3).a, 1);
  }
  // Half of nothing over a background: as the background's light says; transparent: half there, in its own colour.
  Frame frame = frame_of({grey(1), Linear{0, 0, 0, 0}});
  frame.display.background = {0, 0, 0, 1};
  EXPECT_NEAR(gathered({.weight = SampleWeight::Display}, frame, two).shown(DisplayImage(7, 7), frame.display)(3, 3).g,
              encode_srgb(0.5f), 1e-6);
  frame.display.is_transparent = true;
  const Display half =
      gathered({.weight = SampleWeight::Display}, frame, two).shown(DisplayImage(7, 7), frame.display)(3, 3);
  EXPECT_NEAR(half.g, 1, 1e-6);
  EXPECT_NEAR(half.a, 0.5, 1e-6);
}

TEST(SampleGather, AConstantStaysOne) {
  for (const SampleWeight weight : {SampleWeight::Even, SampleWeight::Karis, SampleWeight::Max3})
    for (const std::string_view filter : filter_names) {
      Gathering gathering{.weight = weight, .kernel = {}};
      if (filter != "pixel") gathering.kernel = make_kernel(filter);
      const Frame frame = frame_of({{0.25f, 3, 0.5f, 1}, {0.25f, 3, 0.5f, 1}});
      const LinearImage image = gathered(gathering, frame, two).light();
      for (const Linear& c : image.values()) {
        ASSERT_NEAR(c.r, 0.25f, 2e-6f) << filter;
        ASSERT_NEAR(c.g, 3, 2e-5f) << filter;
        ASSERT_NEAR(c.a, 1, 2e-6f) << filter;
      }
    }
}

TEST(SampleGather, FiltersReachAsFarAsTheirRadius) {
  Frame frame = frame_of({Linear{0, 0, 0, 0}}, 9);
  frame.sample_color[0](4, 4) = grey(1);
  const SamplePattern centre = {SamplePosition{}};
  // A tent of radius 2 at 0 and 1 pixels: 1 and ½ of a sum of 2 in each direction.
  Gathering wide{.weight = {}, .kernel = stretched(make_kernel("tent"), 2 / make_kernel("tent").radius)};
  EXPECT_EQ(wide.reach(), 2);
  const LinearImage image = gathered(wide, frame, centre).light();
  EXPECT_FLOAT_EQ(image(4, 4).g, 0.25f);
  EXPECT_FLOAT_EQ(image(5, 4).g, 0.125f);
  EXPECT_FLOAT_EQ(image(3, 5).g, 0.0625f);
  EXPECT_FLOAT_EQ(image(6, 4).g, 0);
  // A sample at the pixel's right is nearer to the right neighbour.
  const LinearImage right = gathered(wide, frame, {{224, 128}}).light();
  EXPECT_GT(right(5, 4).g, right(3, 4).g);
  EXPECT_GT(right(4, 4).g, right(5, 4).g);
}

TEST(SampleGather, RoundsAddUpAndThreadsLeaveNoTrace) {
  Frame frame = frame_of({grey(0), grey(1)}, 40);
  for (int i = 0; i < 40; ++i) frame.sample_color[0](i, i) = grey(5);
  const Gathering mitchell{.weight = SampleWeight::Karis, .kernel = make_kernel("mitchell")};
  SampleGather rounds(mitchell);
  for (std::size_t s = 0; s < 2; ++s) {
    Frame one;
    one.sample_color.push_back(frame.sample_color[s]);
    rounds.add(one, std::span(two).subspan(s, 1));
  }
  LinearImage many;
  with_threads(3, [&] { many = gathered(mitchell, frame, two).light(); });
  EXPECT_EQ(rounds.light(), many);
}

}  // namespace
}  // namespace zoneplate::antialias
