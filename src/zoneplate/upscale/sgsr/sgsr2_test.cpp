// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/sgsr/sgsr2_core.h"

namespace zoneplate::upscale {
namespace {

constexpr int sgsr2_width = 96, sgsr2_height = 64;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

float2 jitter_of(int index) {
  const auto halton = [](int i, int base) {
    double f = 1, result = 0;
    for (; i > 0; i /= base) f /= base, result += f * (i % base);
    return result;
  };
  const auto rounded = [](double v) { return static_cast<float>(std::floor((v - 0.5) * 256 + 0.5) / 256); };
  return {rounded(halton(index + 1, 2)), rounded(halton(index + 1, 3))};
}

Sgsr2Frame constant(int index, Linear color) {
  return {.color = LinearImage(sgsr2_width, sgsr2_height, color),
          .depth = Plane<float>(sgsr2_width, sgsr2_height, 0.5f),
          .motion_x = Plane<float>(sgsr2_width, sgsr2_height, nan),
          .motion_y = Plane<float>(sgsr2_width, sgsr2_height, nan),
          .jitter = jitter_of(index),
          .half_width = 0.75f,
          .is_first = index == 0};
}

/// Small squares, in whole numbers: the upper half is an object that moves to the left by a pixel per frame, the lower
/// one rests while the camera moves.
Sgsr2Frame squares(int index) {
  Sgsr2Frame frame = constant(index, {0, 0, 0, 1});
  frame.is_camera_at_rest = index == 0;
  if (index > 0) frame.last_clip_from_clip.column[3].x = 1.0f / 64;
  for (int y = 0; y < sgsr2_height; ++y)
    for (int x = 0; x < sgsr2_width; ++x) {
      const int moved = x + index;
      const float v = static_cast<float>((moved * 7 + y * 13 + moved / 5 * (y / 3) * 3) % 16) / 16 * 0.75f + 0.05f;
      frame.color(x, y) = {v, 0.5f * v + 0.1f, (moved + y) % 8 == 0 ? 1.75f : 0.25f, 1};
      frame.depth(x, y) = 0.5f + static_cast<float>(y) / 256;
      if (index > 0 && y < 32) frame.motion_x(x, y) = -2.0f / sgsr2_width, frame.motion_y(x, y) = 0;
    }
  return frame;
}

// Figures of Qualcomm's own shaders, compiled with 32-bit storage and run by lavapipe. In sequences of 32 frames, still
// and moving, at three ratios, motion, depth clip and coded colours were equal, first images agreed by 142 dB and all
// others by 60 dB: where the history lies on the border of the colours around it, rounding decides how much it counts.
// With a tolerance of 2e-6 in that comparison, in the shader and here, a still sequence agrees by 101 dB.
TEST(Sgsr2, AgreesWithFiguresOfTheShaders) {
  Sgsr2 sgsr2(2 * sgsr2_width, 2 * sgsr2_height);
  struct Figures {
    double sum, square;
  };
  for (const int index : {0, 1}) {
    const Figures expected = index == 0 ? Figures{25938.738793, 18772.994842} : Figures{24271.721379, 13958.648589};
    const LinearImage image = sgsr2.accumulate(squares(index));
    double sum = 0, square = 0;
    for (int y = 4; y < image.height() - 4; ++y)  // the shader's lookups beyond the frame are undefined
      for (int x = 4; x < image.width() - 4; ++x)
        for (const float v : {image(x, y).r, image(x, y).g, image(x, y).b})
          sum += double{v}, square += double{v} * double{v};
    EXPECT_NEAR(sum, expected.sum, 0.02);
    EXPECT_NEAR(square, expected.square, 0.05);
  }
}

TEST(Sgsr2, ConstantLightDarkensAsInTheShader) {
  Sgsr2 sgsr2(2 * sgsr2_width, 2 * sgsr2_height);
  const float light = 0.25f, code = std::floor(light / (1 + light) * 2047.5f) / 2047.5f;
  const float restored = code / (1 + 600.0f / 65504 - code);
  LinearImage image;
  for (int i = 0; i < 8; ++i) image = sgsr2.accumulate(constant(i, {light, light, light, 1}));
  for (const Linear& c : image.values()) {
    ASSERT_NEAR(c.g, restored, 2e-3f);
    ASSERT_EQ(c.a, 1);
  }
}

// The light of every row of a tilted edge is that of the edge's place, where one frame has steps of two pixels.
TEST(Sgsr2, StillFramesAccumulate) {
  Sgsr2 sgsr2(2 * sgsr2_width, 2 * sgsr2_height);
  double first = 0, last = 0;
  for (int i = 0; i < 32; ++i) {
    Sgsr2Frame frame = constant(i, {0, 0, 0, 1});
    for (int y = 0; y < sgsr2_height; ++y)
      for (int x = 0; x < sgsr2_width; ++x) {
        const float px = static_cast<float>(x) + 0.5f - frame.jitter.x;
        const float py = static_cast<float>(y) + 0.5f - frame.jitter.y;
        const float v = px + 0.3f * py > 60 ? 0.8f : 0.1f;
        frame.color(x, y) = {v, v, v, 1};
      }
    const LinearImage image = sgsr2.accumulate(frame);
    double error = 0;
    for (int y = 8; y < 2 * sgsr2_height - 8; ++y) {
      double lit = 0;
      const double dark = double{image(20, y).g}, light = double{image(2 * sgsr2_width - 10, y).g};
      for (int x = 0; x < 2 * sgsr2_width; ++x) lit += (double{image(x, y).g} - dark) / (light - dark);
      const double exact = 2 * sgsr2_width - 2 * (60 - 0.3 * (y + 0.5) / 2);
      error += std::abs(lit - exact) / (2 * sgsr2_height - 16);
    }
    (i == 0 ? first : last) = error;
  }
  EXPECT_GT(first, 0.3);
  EXPECT_LT(last, 0.5 * first);
}

TEST(Sgsr2, SameBitsOnEveryInstructionSet) {
  const auto made = [] {
    Sgsr2 sgsr2(2 * sgsr2_width + 1, 2 * sgsr2_height - 3);
    LinearImage image;
    for (int i = 0; i < 4; ++i) image = sgsr2.accumulate(squares(i));
    return image;
  };
  const LinearImage expected = with_isa(Isa::Scalar, made);
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] { with_threads(3, [&] { EXPECT_EQ(made(), expected) << name_of(isa); }); });
}

}  // namespace
}  // namespace zoneplate::upscale
