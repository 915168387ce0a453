// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "zoneplate/antialias/temporal/sequences_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

/// The samples of frames alone, at the jitter of history-guided.
constexpr const char* samples_alone = "taa:blend=fixed,alpha=1,bias=0,rest=test";

std::array<float, 4> channels(const Linear& c) { return {c.r, c.g, c.b, c.a}; }

/// A square that moves by 1.3 pixels per frame, and by 30 in frame 5.
MovingScene moving_square() {
  return square_before_wall([](int i) {
    return float2{-25 + 1.3f * static_cast<float>(i) + (i >= 5 ? 30.0f : 0.0f), 0.3f * static_cast<float>(i)};
  });
}

TEST(HistoryGuided, EveryColourLiesBetweenThoseOfNineSamplesOfItsFrame) {
  const std::vector<LinearImage> guided = film(moving_square(), "history-guided", 8);
  const std::vector<LinearImage> samples = film(moving_square(), samples_alone, 8);
  for (std::size_t f = 0; f < guided.size(); ++f)
    for (int y = 0; y < guided[f].height(); ++y)
      for (int x = 0; x < guided[f].width(); ++x) {
        std::array<float, 4> low, high;
        low.fill(1e9f), high.fill(-1e9f);
        for (int k = 0; k < 9; ++k) {
          const int u = std::clamp(x + k % 3 - 1, 0, guided[f].width() - 1);
          const int v = std::clamp(y + k / 3 - 1, 0, guided[f].height() - 1);
          const auto near = channels(samples[f](u, v));
          for (std::size_t c = 0; c < 4; ++c) low[c] = std::min(low[c], near[c]), high[c] = std::max(high[c], near[c]);
        }
        const auto color = channels(guided[f](x, y));
        for (std::size_t c = 0; c < 4; ++c) {
          ASSERT_GE(color[c], low[c] - 1e-6f) << f << ": " << x << ", " << y;
          ASSERT_LE(color[c], high[c] + 1e-6f) << f << ": " << x << ", " << y;
        }
      }
}

TEST(HistoryGuided, AnEdgeAtRestChangesLessThanItsSamples) {
  const MovingScene still = square_before_wall([](int) { return float2{0.37f, 0.21f}; });
  // Changes between frames after the jitter's first period.
  const auto changes = [&](const char* method) {
    const std::vector<LinearImage> frames = film(still, method, 40);
    double sum = 0;
    for (std::size_t f = 17; f < frames.size(); ++f) sum += rms(frames[f], frames[f - 1]);
    return sum;
  };
  EXPECT_LT(changes("history-guided"), 0.6 * changes(samples_alone));
}

TEST(HistoryGuided, OneColourStaysThatColour) {
  MovingScene wall = square_before_wall([](int i) { return float2{200 + 0.7f * static_cast<float>(i), 0}; });
  const LinearImage first = last_frame(wall, "history-guided", 1);
  wall.camera = [camera = wall.camera(0)](int i) {
    Camera moved = camera;
    moved.world_from_camera = camera.world_from_camera * translation(float3{0.0123f * static_cast<float>(i), 0.01f, 0});
    return moved;
  };
  EXPECT_EQ(last_frame(wall, "history-guided", 6), first);
}

TEST(HistoryGuided, BitsAreThoseOfEveryInstructionSetAndNumberOfThreads) {
  const MovingScene moving = moving_square();
  const LinearImage scalar = with_isa(Isa::Scalar, [&] { return last_frame(moving, "history-guided", 4); });
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 3})
      with_isa(isa, [&] {
        with_threads(threads, [&] { EXPECT_EQ(last_frame(moving, "history-guided", 4), scalar) << name_of(isa); });
      });
}

}  // namespace
}  // namespace zoneplate::antialias
