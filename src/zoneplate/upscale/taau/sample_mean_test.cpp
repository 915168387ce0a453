// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/taau/sample_mean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/taau/taau_frames_for_test.h"

namespace zoneplate::upscale {
namespace {

using namespace taau_frames;

/// The mean of all samples of all frames, with the weight exp(-2.29 d²) of the distance in output pixels.
double weighted_mean(int x, int y, int frames, const LightAt& light) {
  double sum = 0, weights = 0;
  for (int i = 0; i < frames; ++i) {
    const SamplePosition at = sample_at(i);
    for (int v = y / scale - 3; v <= y / scale + 3; ++v)
      for (int u = x / scale - 3; u <= x / scale + 3; ++u) {
        const double px = u + at.x / 256.0, py = v + at.y / 256.0;
        const double dx = px * scale - x - 0.5, dy = py * scale - y - 0.5;
        const double weight = std::exp(-2.29 * (dx * dx + dy * dy));
        sum += weight * light(px, py, i), weights += weight;
      }
  }
  return sum / weights;
}

/// Output pixels that are not measured on each side.
constexpr int margin = 10;
double rms_error(const LinearImage& image, const std::function<double(int x, int y)>& expected) {
  double sum = 0;
  int count = 0;
  for (int y = margin; y < scale * height - margin; ++y)
    for (int x = margin; x < scale * width - margin; ++x, ++count)
      sum += std::pow(double{image(x, y).r} - expected(x, y), 2);
  return std::sqrt(sum / count);
}

/// Wires of a third of a frame's pixel, whose samples most frames miss.
double missed_wires(double x, double y, int) {
  const double place = x + 0.37 * y;
  return std::abs(place - 5 * std::floor(place / 5) - 2.5) < 0.17 ? 0.9 : 0.1;
}

TEST(SampleMean, AtRestItIsTheWeightedMeanOfAllSamples) {
  const LightAt slope = [](double x, double y, int) { return 0.2 + 0.01 * x + 0.004 * y; };
  const LinearImage image = after<SampleMean>(32, slope);
  for (int y = margin; y < scale * height - margin; ++y)
    for (int x = margin; x < scale * width - margin; ++x)
      ASSERT_NEAR(double{image(x, y).r}, weighted_mean(x, y, 32, slope), 2e-5) << x << ',' << y;
}

// The extremes of earlier frames contain what this frame's samples miss.
TEST(SampleMean, KeepsWiresThatFramesMiss) {
  const auto expected = [](int x, int y) { return weighted_mean(x, y, 32, missed_wires); };
  const double error = rms_error(after<SampleMean>(32, missed_wires), expected);
  EXPECT_LT(error, 0.01);
  EXPECT_LT(error, 0.2 * rms_error(after<Taau>(32, missed_wires), expected));
}

TEST(SampleMean, AMotionByWholePixelsKeepsTheBits) {
  constexpr int frames = 6;
  const LinearImage rest = after<SampleMean>(frames, missed_wires),
                    moved = after<SampleMean>(frames, missed_wires, {1, -1});
  const int shift = scale * (frames - 1);
  for (int y = margin; y < scale * height - margin - shift; ++y)
    for (int x = margin + shift; x < scale * width - margin; ++x)
      ASSERT_EQ(moved(x, y), rest(x - shift, y + shift)) << x << ',' << y;
}

TEST(SampleMean, OneColourStaysThatColour) {
  // A scale of its own along each axis, and one at which samples lie far from some pixels.
  for (const auto& [w, h] : {std::pair(67, 41), std::pair(15 * width, 12 * height)}) {
    SampleMean mean(w, h);
    for (int i = 0; i < 5; ++i) {
      const LinearImage image = mean.accumulate(frame_of([](double, double, int) { return 0.3; }, i, {0.3f, -1.7f}));
      for (const Linear& c : image.values()) ASSERT_EQ(c, (Linear{0.3f, 0.15f, 0.075f, 1})) << w;
    }
  }
}

constexpr int change = 12;  // the frame in which the light changes
/// The images of frames `first` to `last`, the first of which has no history, of light that changes by a factor.
LinearImage image_of(int first, int last, double factor, const LightAt& light) {
  const LightAt changing = [&](double x, double y, int frame) {
    return light(x, y, 0) * (frame < change ? 1 : factor);
  };
  SampleMean mean(scale * width, scale * height);
  LinearImage image;
  for (int i = first; i <= last; ++i) {
    TaauInput frame = frame_of(changing, i);
    frame.is_first = i == first;
    image = mean.accumulate(frame);
  }
  return image;
}

TEST(SampleMean, LightThatChangesAtOnceLeavesNothing) {
  const LightAt texture = [](double x, double y, int) { return 0.5 + 0.1 * std::sin(1.3 * x + 0.4 * y); };
  for (const double factor : {3.0, 0.3}) {
    const LinearImage fresh = image_of(change, change, factor, texture);
    const double error =
        rms_error(image_of(0, change, factor, texture), [&](int x, int y) { return double{fresh(x, y).r}; });
    EXPECT_LT(error, 1e-6) << factor;
  }
}

// Between missed_wires the new light is one that the last frames had: it is followed over some frames.
TEST(SampleMean, LightThatChangesBetweenWiresIsFollowed) {
  const auto error = [](int first, int last) {
    return rms_error(image_of(first, last, 3, missed_wires),
                     [](int x, int y) { return 3 * weighted_mean(x, y, 32, missed_wires); });
  };
  EXPECT_LT(error(0, change + 12), 1.2 * error(change, change + 12));
}

TEST(SampleMean, LightThatChangesSlowlyIsFollowed) {
  const auto at = [](int frame) { return 0.3 + 0.5 * std::clamp(frame - 8, 0, 24) / 24; };
  const LightAt light = [&](double, double, int frame) { return at(frame); };
  SampleMean mean(scale * width, scale * height);
  for (int i = 0; i < 40; ++i) {
    const LinearImage image = mean.accumulate(frame_of(light, i));
    const double now = at(i);
    EXPECT_LT(rms_error(image, [&](int, int) { return now; }), 0.12 * now) << i;
    if (i == 39) {
      EXPECT_LT(rms_error(image, [&](int, int) { return now; }), 0.01 * now);
    }
  }
}

/// Six frames of a square, nearer than its background, that jumps by sixteen pixels in the last one.
std::vector<TaauInput> jump(const LightAt& background) {
  std::vector<TaauInput> out;
  for (int i = 0; i < 6; ++i) {
    const int left = i < 5 ? 8 : 24;
    TaauInput& frame = out.emplace_back(frame_of(background, i));
    for (int y = 10; y < 18; ++y)
      for (int x = left; x < left + 8; ++x) {
        frame.color(x, y) = {0.5f, 0.5f, 0.5f, 1}, frame.nearness(x, y) = 0.8f;
        if (i == 5) frame.motion_x(x, y) = 16;
      }
  }
  return out;
}

TEST(SampleMean, WhatLeavesIsForgottenAtOnce) {
  // Where it was, the colour of the square lies between those of the background.
  for (const LightAt& background : {LightAt(missed_wires), LightAt([](double, double, int) { return 0.1; })}) {
    std::vector<TaauInput> frames = jump(background);
    SampleMean mean(scale * width, scale * height), fresh(scale * width, scale * height);
    LinearImage image;
    for (const TaauInput& frame : frames) image = mean.accumulate(frame);
    frames.back().is_first = true;
    const LinearImage alone = fresh.accumulate(frames.back());
    EXPECT_NEAR(image(scale * 28, scale * 14).r, 0.5f, 1e-5f);
    for (int y = scale * 11; y < scale * 17; ++y)
      for (int x = scale * 9; x < scale * 15; ++x) ASSERT_NEAR(image(x, y).r, alone(x, y).r, 1e-6f) << x << ',' << y;
  }
}

TEST(SampleMean, SameBitsOnEveryInstructionSetAndThreadCount) {
  const LightAt light = [](double x, double y, int frame) { return missed_wires(x, y, 0) * (frame < 3 ? 1.0 : 2.5); };
  const LinearImage expected = with_isa(Isa::Scalar, [&] { return after<SampleMean>(5, light, {0.4f, -0.3f}); });
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] {
      with_threads(3, [&] { EXPECT_EQ(after<SampleMean>(5, light, {0.4f, -0.3f}), expected) << name_of(isa); });
    });
}

}  // namespace
}  // namespace zoneplate::upscale
