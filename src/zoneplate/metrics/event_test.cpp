// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/event.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

/// A white square of a quarter of the image is gone from frame `end` on.
LinearImage scene(int frame, int end) {
  LinearImage image(16, 16, {0.25f, 0.125f, 0.5f, 1});
  if (frame < end)
    for (int y = 4; y < 12; ++y)
      for (int x = 4; x < 12; ++x) image(x, y) = {1, 1, 1, 1};
  return image;
}

struct Films {
  std::vector<Picture> reference, test;
};

/// History of weight 1 − `weight` of the frames of `scene`; every frame of it is `offset` too bright.
Films films(float weight, float offset = 0, int count = 12, int end = 3) {
  Films out;
  LinearImage history = scene(0, end);
  for (int frame = 0; frame < count; ++frame) {
    const LinearImage now = scene(frame, end);
    LinearImage shown(16, 16);
    for (std::size_t i = 0; i < now.values().size(); ++i) {
      Linear& h = history.values()[i];
      const Linear& c = now.values()[i];
      h = {h.r + weight * (c.r - h.r), h.g + weight * (c.g - h.g), h.b + weight * (c.b - h.b), 1};
      // Opposite in pixels beside each other, so that it does not correlate with the change.
      const float error = i % 2 == 0 ? offset : -offset;
      shown.values()[i] = {h.r + error, h.g + error, h.b + error, 1};
    }
    out.reference.push_back(make_picture(now)), out.test.push_back(make_picture(shown));
  }
  return out;
}

Comparison measured(const Films& films, std::string_view metric, Unfit unfit = Unfit::Refuse) {
  const Comparands pictures{.count = films.reference.size(),
                            .reference = [&](std::size_t i) { return films.reference[i]; },
                            .test = [&](std::size_t i) { return films.test[i]; },
                            .are_frames = true};
  const Choice choices[] = {choose_metric(metrics(), metric)};
  return compare(pictures, choices, unfit);
}

TEST(Ghost, OfExponentialHistoryIsItsWeight) {
  for (const float weight : {0.05f, 0.1f, 0.25f, 0.5f}) {
    const Comparison c = measured(films(weight), "ghost");
    ASSERT_EQ(c.results[0].values.size(), 1u);  // one window in five begins at the event
    EXPECT_NEAR(c.results[0].value, 1 - weight, 1e-6);
    EXPECT_NEAR(c.results[0].score.more[0].value, std::log(0.5) / std::log(1 - weight), 1e-4);
    EXPECT_NEAR(c.results[0].score.more[1].value, std::pow(1 - weight, 7), 1e-6);
    EXPECT_NEAR(measured(films(weight), "lag").results[0].value, std::log(0.1) / std::log(1 - weight), 1e-4);
  }
}

TEST(Ghost, NoiseIsNone) {
  EXPECT_NEAR(measured(films(1, 0.05f), "ghost").results[0].value, 0, 1e-7);
  EXPECT_NEAR(measured(films(0.25f, 0.05f), "ghost").results[0].value, 0.75, 1e-6);
}

TEST(Lag, IsNoneWithoutHistoryAndEndlessWithoutChange) {
  EXPECT_EQ(measured(films(1), "lag").results[0].value, 0);
  Films frozen = films(1);
  frozen.test.assign(frozen.test.size(), frozen.test[0]);
  EXPECT_EQ(measured(frozen, "lag").results[0].value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(measured(frozen, "ghost").results[0].value, 1);
}

TEST(Ghost, IsLeftOutOfSequencesWithoutAnEvent) {
  EXPECT_TRUE(measured(films(0.1f, 0, 12, 0), "ghost", Unfit::Leave).results.empty());
  EXPECT_THROW(measured(films(0.1f, 0, 12, 0), "ghost"), std::exception);
}

TEST(Recpsnr, IsThatOfTheLastFrame) {
  Films f = films(1);
  const LinearImage black(16, 16, {0, 0, 0, 1});
  for (std::size_t i = 0; i < f.test.size(); ++i) f.test[i] = f.reference[i];
  EXPECT_EQ(measured(f, "recpsnr").results[0].value, std::numeric_limits<double>::infinity());
  f.test[5] = make_picture(black);  // an earlier frame does not count
  EXPECT_EQ(measured(f, "recpsnr").results[0].value, std::numeric_limits<double>::infinity());
  f.test.back() = make_picture(DisplayImage(16, 16, {0.5f, 0.5f, 0.5f, 1}));
  f.reference.back() = make_picture(DisplayImage(16, 16, {0.75f, 0.75f, 0.75f, 1}));
  EXPECT_NEAR(measured(f, "recpsnr").results[0].value, 20 * std::log10(4), 1e-9);
}

}  // namespace
}  // namespace zoneplate::metrics
