// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/fsr/frames_for_test.h"
#include "zoneplate/upscale/fsr2/fsr2_core.h"

namespace zoneplate::upscale {
namespace {

LinearImage after_fsr2(int frames, const Pattern& light, float2 motion = {0, 0}, const Fsr2Options& options = {}) {
  const int phases = fsr_phases(frame_width, 2 * frame_width);
  Fsr2 fsr2(2 * frame_width, 2 * frame_height, options);
  LinearImage image;
  for (int i = 0; i < frames; ++i) image = fsr2.accumulate(frame_of(light, i, phases, motion));
  return image;
}

TEST(Fsr2, PhasesOfThePresets) {
  EXPECT_EQ(fsr_phases(1280, 1920), 18);
  EXPECT_EQ(fsr_phases(1129, 1920), 23);
  EXPECT_EQ(fsr_phases(960, 1920), 32);
  EXPECT_EQ(fsr_phases(640, 1920), 72);
  // Halton 2, 3 from element 1, around 0.
  EXPECT_EQ(fsr_jitter(0, 18).x, 0);
  EXPECT_NEAR(fsr_jitter(0, 18).y, 1.0 / 3 - 0.5, 1.0 / 512);
  EXPECT_EQ(fsr_jitter(18, 18).x, fsr_jitter(0, 18).x);
}

// Figures of AMD's own shaders, compiled with 32-bit storage and run by lavapipe. In all 32 frames of other sequences,
// still and moving, at four ratios, their locks and depths were equal, and the outputs agreed by 58 to 70 dB: where the
// history lies on the border of the colours around it, rounding decides how much it counts.
TEST(Fsr2, AgreesWithFiguresOfTheShaders) {
  struct Figures {
    int frames;
    double exposure, sum, square;
    int locks;
  };
  for (const Figures& f : {Figures{1, 0.33473474, 28813.925445, 19414.137214, 1973},
                           {2, 0.33452788, 28719.901451, 18522.889802, 1976},
                           {4, 0.33408850, 28237.680115, 16506.998490, 1981},
                           {5, 0.33392799, 27846.983252, 14816.733194, 1966}}) {
    const int phases = fsr_phases(96, 192);
    Fsr2 fsr2(192, 128, {});
    LinearImage image;
    for (int i = 0; i < f.frames; ++i) image = fsr2.accumulate(squares(i, phases));
    double sum = 0, square = 0;
    int locks = 0;
    for (const Linear& c : image.values())
      for (const float v : {c.r, c.g, c.b}) sum += double{v}, square += double{v} * double{v};
    for (const float v : fsr2.passes().new_locks.values()) locks += v > 0;
    EXPECT_NEAR(fsr2.passes().exposure, f.exposure, 2e-7) << f.frames;
    EXPECT_NEAR(sum, f.sum, 5e-3) << f.frames;
    EXPECT_NEAR(square, f.square, 5e-3) << f.frames;
    EXPECT_EQ(locks, f.locks) << f.frames;
  }
}

TEST(Fsr2, AStillImageConverges) {
  const double one = error_of(after_fsr2(1, edge), edge), many = error_of(after_fsr2(32, edge), edge);
  EXPECT_LT(many, 0.6 * one);
  EXPECT_LT(many, 0.02);
}

TEST(Fsr2, AMovingImageKeepsItsHistory) {
  // Whole output pixels a frame: the image is that of the last frame's position.
  const float2 motion{0.5f, -1};
  const int frames = 24;
  const Pattern moved = [&](float x, float y) {
    const auto n = static_cast<float>(frames - 1);
    return edge(x - n * motion.x / frame_width, y - n * motion.y / frame_width);
  };
  const double error = error_of(after_fsr2(frames, edge, motion), moved);
  EXPECT_LT(error, 0.8 * error_of(after_fsr2(1, moved), moved));
}

TEST(Fsr2, LanczosKernelsAreSharper) {
  const Fsr2Options without{.has_lanczos = false};
  EXPECT_LT(error_of(after_fsr2(24, edge), edge), 0.9 * error_of(after_fsr2(24, edge, {0, 0}, without), edge));
  // Half an output pixel per frame, so that history is interpolated in every second one.
  const float2 motion{0.25f, 0};
  const Pattern moved = [&](float x, float y) { return edge(x - 23 * motion.x / frame_width, y); };
  EXPECT_LT(error_of(after_fsr2(24, edge, motion), moved),
            0.9 * error_of(after_fsr2(24, edge, motion, without), moved));
}

TEST(Fsr2, ConstantLightStays) {
  const LinearImage image = after_fsr2(6, [](float, float) { return 0.3f; });
  for (const Linear& c : image.values()) {
    ASSERT_NEAR(c.r, 0.3f, 2e-3f);  // at the sides, samples beyond the frame count as black, as in the shader
    ASSERT_EQ(c.a, 1);
  }
  for (int y = 4; y < image.height() - 4; ++y)
    for (int x = 4; x < image.width() - 4; ++x) ASSERT_NEAR(image(x, y).g, 0.3f, 1e-5f);
}

TEST(Fsr2, ExposureOfMidGrey) {
  const int phases = 32;
  Fsr2 fsr2(128, 128, {});
  FsrFrame frame{.color = LinearImage(64, 64, Linear{0.18f, 0.18f, 0.18f, 1}),
                 .depth = Plane<float>(64, 64, 1.0f),
                 .motion = Plane<float2>(64, 64),
                 .jitter = fsr_jitter(0, phases)};
  fsr2.accumulate(frame);
  EXPECT_NEAR(fsr2.passes().exposure, 1 / (9.6 * 0.18), 1e-4);
}

TEST(Fsr2, LinesAndDotsAreLockedAndSurfacesAreNot) {
  const int phases = 32;
  const auto locks = [&](const std::function<bool(int, int)>& is_light) {
    FsrFrame frame = frame_of([](float, float) { return 0.2f; }, 0, phases);
    frame.jitter = {0, 0};
    for (int y = 0; y < frame_height; ++y)
      for (int x = 0; x < frame_width; ++x)
        if (is_light(x, y)) frame.color(x, y) = {0.8f, 0.8f, 0.8f, 1};
    Fsr2 fsr2(2 * frame_width, 2 * frame_height, {});
    fsr2.accumulate(frame);
    int count = 0;
    for (const float v : fsr2.passes().new_locks.values()) count += v > 0;
    return count;
  };
  EXPECT_EQ(locks([](int, int) { return false; }), 0);
  EXPECT_EQ(locks([](int x, int y) { return x == 20 && y == 15; }), 1);
  EXPECT_EQ(locks([](int x, int) { return x == 20; }), frame_height);
  EXPECT_EQ(locks([](int x, int y) { return x == y + 3; }), frame_height);
  EXPECT_EQ(locks([](int x, int) { return x == 20 || x == 21; }), 0);
  EXPECT_EQ(locks([](int x, int) { return x >= 20; }), 0);
}

TEST(Fsr2, SurfacesThatWereHiddenAreClipped) {
  // A square at depth 1 before a wall at depth 5 moves by 4 pixels to the right and uncovers the wall.
  const auto scene = [&](int index) {
    FsrFrame frame = frame_of([](float, float) { return 0.2f; }, index, 32);
    for (int y = 12; y < 24; ++y)
      for (int x = 12 + 4 * index; x < 24 + 4 * index; ++x) {
        frame.depth(x, y) = 1, frame.color(x, y) = {0.8f, 0.8f, 0.8f, 1};
        if (index > 0) frame.motion(x, y) = {4, 0};
      }
    return frame;
  };
  Fsr2 fsr2(2 * frame_width, 2 * frame_height, {});
  fsr2.accumulate(scene(0));
  const LinearImage image = fsr2.accumulate(scene(1));
  const auto clip = [&](int x, int y) { return fsr2.passes().prepared(x + 1, y + 1).a; };
  EXPECT_GT(clip(13, 18), 0.9f);
  EXPECT_EQ(clip(40, 18), 0);
  EXPECT_EQ(clip(22, 18), 0);
  EXPECT_NEAR(image(27, 37).g, 0.2f, 0.02f);  // no ghost of the square
}

TEST(Fsr2, SameBitsOnEveryInstructionSet) {
  const Pattern lines = [](float x, float y) { return std::sin(200 * x + 90 * y) > 0.7f ? 1.5f : 0.2f; };
  const Fsr2Options options{.sharpens = true, .sharpness = 0.8f};
  const LinearImage expected = with_isa(Isa::Scalar, [&] { return after_fsr2(5, lines, {0.3f, 0.7f}, options); });
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] {
      with_threads(3, [&] { EXPECT_EQ(after_fsr2(5, lines, {0.3f, 0.7f}, options), expected) << name_of(isa); });
    });
}

}  // namespace
}  // namespace zoneplate::upscale
