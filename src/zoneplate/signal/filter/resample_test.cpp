// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/resample.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/signal/noise_for_test.h"

namespace zoneplate {
namespace {

constexpr std::pair<int, int> sizes[] = {{64, 48}, {32, 24}, {17, 13}, {100, 75}, {192, 144}, {1, 1}, {65, 47}};

class ResampleWith : public testing::TestWithParam<std::string> {};

TEST_P(ResampleWith, AConstantStaysThatConstantToTheBit) {
  const Kernel kernel = make_kernel(GetParam());
  for (const float value : {1.0f, 0.1f, 0.7843137f, 12345.678f, -3e-5f})
    for (const auto& [w, h] : sizes)
      for (const Border border : {Border::Clamp, Border::Reflect, Border::Wrap})
        ASSERT_EQ(resample(Plane<float>(64, 48, value), w, h, kernel, {.border = border}), Plane<float>(w, h, value));
}

TEST_P(ResampleWith, ARampStaysARampAwayFromBorders) {
  const Kernel kernel = make_kernel(GetParam());
  const bool has_linear_precision =
      GetParam() == "tent" || GetParam() == "mitchell" || GetParam() == "catmull-rom" || GetParam() == "b-spline";
  Plane<float> ramp(120, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 120; ++x) ramp(x, y) = static_cast<float>(x) / 128;
  for (const int w : {40, 60, 100, 120, 240, 360, 32, 77}) {
    const double step = 120.0 / w, reach = kernel.radius * std::max(1.0, step) + 1;
    const auto out = resample(ramp, w, 3, kernel);
    // In minification by a fractional factor, even these kernels displace a ramp slightly; measured.
    const bool is_exact = has_linear_precision && (step <= 1 || step == std::floor(step));
    const double tolerance = is_exact || step == std::floor(step) ? 0 : place_error(kernel, step) * step;
    for (int x = 0; x < w; ++x) {
      const double centre = (x + 0.5) * step - 0.5;
      if (centre < reach || centre > 119 - reach) continue;
      EXPECT_NEAR(out(x, 1) * 128.0, centre, tolerance + 2e-5) << w << " " << x;
    }
    if (is_exact) {
      EXPECT_LT(place_error(kernel, std::min(step, 1.0)), 1e-13);
    }
  }
}

TEST_P(ResampleWith, NothingIsShifted) {
  // Mirroring commutes with resampling; a shift by a fraction of a pixel would break this.
  const Kernel kernel = make_kernel(GetParam());
  const Plane<float> plane = noise_plane(37, 5);
  Plane<float> mirror = plane;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 37; ++x) mirror(x, y) = plane(36 - x, 4 - y);
  for (const auto& [w, h] : {std::pair{19, 3}, {37, 5}, {74, 11}, {50, 2}}) {
    const auto out = resample(plane, w, h, kernel), mirrored = resample(mirror, w, h, kernel);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) EXPECT_NEAR(out(x, y), mirrored(w - 1 - x, h - 1 - y), 3e-7);
  }
  // An interpolating kernel at the same size is the identity; a shift by whole pixels is exact.
  if (kernel.name == "catmull-rom" || kernel.name == "lanczos3" || kernel.name == "tent" || kernel.name == "box") {
    EXPECT_EQ(resample(plane, 37, 5, kernel), plane);
    const auto moved = resample(plane, 37, 5, kernel, {.border = Border::Wrap, .shift_x = 3, .shift_y = -1});
    for (int x = 0; x < 34; ++x) EXPECT_EQ(moved(x, 2), plane(x + 3, 1));
  }
  // Shifting by the step moves the output by one pixel.
  const auto a = resample(plane, 12, 5, kernel, {.border = Border::Wrap, .step_x = 3});
  const auto b = resample(plane, 12, 5, kernel, {.border = Border::Wrap, .step_x = 3, .shift_x = 3});
  for (int x = 0; x < 11; ++x) EXPECT_EQ(b(x, 3), a(x + 1, 3));
}

INSTANTIATE_TEST_SUITE_P(Kernels, ResampleWith,
                         testing::Values("box", "tent", "gaussian", "mitchell", "catmull-rom", "b-spline", "lanczos2",
                                         "lanczos3", "blackman-harris", "kaiser"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(Resample, TheMeanOfTwoByTwoPixelsIsTheBox) {
  const Plane<float> plane = noise_plane(8, 6);
  const auto out = resample(plane, 4, 3, make_kernel("box"));
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_NEAR(
          out(x, y),
          (plane(2 * x, 2 * y) + plane(2 * x + 1, 2 * y) + plane(2 * x, 2 * y + 1) + plane(2 * x + 1, 2 * y + 1)) / 4,
          1e-7);
  const auto big = resample(plane, 24, 18, make_kernel("box"));
  for (int x = 0; x < 24; ++x) EXPECT_EQ(big(x, 7), plane(x / 3, 2));
}

TEST(Resample, NearestTakesThePixelUnderTheCentre) {
  const Plane<float> plane = noise_plane(9, 6);
  const auto out = resample_nearest(plane, 3, 2);
  EXPECT_EQ(out(1, 0), plane(4, 1));
  EXPECT_EQ(out(2, 1), plane(7, 4));
  EXPECT_EQ(resample_nearest(plane, 9, 6), plane);
  EXPECT_EQ(resample_nearest(Plane<float>(), 2, 1), Plane<float>(2, 1));
  LinearImage image(2, 1);
  image(1, 0).g = 5;
  EXPECT_EQ(resample_nearest(image, 1, 1)(0, 0).g, 5.0f);
}

TEST(Resample, TheIdealResultIsTheWaveItselfOnTheNewGrid) {
  for (const auto& [in, out] : {std::pair{40, 20}, {40, 27}, {37, 10}, {20, 33}, {20, 40}, {24, 24}, {21, 21}}) {
    Plane<float> wave(in, 4);
    const auto value = [n = in](double x) {
      return 0.3 + std::cos(2 * M_PI * 3 * x / n + 0.7) + std::sin(2 * M_PI * 4 * x / n);
    };
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < in; ++x) wave(x, y) = static_cast<float>(value(x));
    const auto found = resample_ideal(wave, out, 4);
    for (int x = 0; x < out; ++x) EXPECT_NEAR(found(x, 2), value((x + 0.5) * in / out - 0.5), 1e-6) << in << " " << out;
  }
  const Plane<float> plane = noise_plane(12, 10);
  const auto same = resample_ideal(plane, 12, 10);
  for (std::size_t i = 0; i < plane.values().size(); ++i) EXPECT_NEAR(same.values()[i], plane.values()[i], 1e-6);
}

TEST(Resample, GivesTheSameBitsOnEveryInstructionSetAndNumberOfThreads) {
  const Kernel kernel = make_kernel("lanczos3");
  const Plane<float> plane = noise_plane(53, 41);
  LinearImage image(53, 41);
  for (std::size_t i = 0; i < plane.values().size(); ++i) image.values()[i].b = plane.values()[i];
  const auto expected = with_isa(Isa::Scalar, [&] { return resample(plane, 31, 67, kernel); });
  const auto expected_image = with_isa(Isa::Scalar, [&] { return resample(image, 31, 67, kernel); });
  for (std::size_t i = 0; i < expected.values().size(); ++i)
    EXPECT_EQ(expected_image.values()[i].b, expected.values()[i]);
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 3, 7})
      with_isa(isa, [&] {
        with_threads(threads, [&] {
          EXPECT_EQ(resample(plane, 31, 67, kernel), expected);
          EXPECT_EQ(resample(image, 31, 67, kernel), expected_image);
        });
      });
}

TEST(Resample, NothingIn) {
  EXPECT_TRUE(resample(Plane<float>(4, 4), 0, 3, make_kernel("tent")).empty());
  EXPECT_EQ(resample(Plane<float>(), 2, 3, make_kernel("tent")), Plane<float>(2, 3));
  // The zero border is transparent black, in colour and alpha.
  EXPECT_LT(resample(LinearImage(2, 2, {1, 1, 1, 1}), 2, 2, make_kernel("b-spline"), {.border = Border::Zero})(0, 0).a,
            1.0f);
}

// All machines and compilers give the same bits.
TEST(Resample, GivesTheBitsThatItAlwaysGave) {
  std::uint64_t bits = 14695981039346656037u;
  for (const char* name : {"lanczos3", "mitchell", "gaussian", "kaiser"}) {
    const auto out = resample(noise_plane(53, 41), 31, 67, make_kernel(name));
    for (const float v : out.values()) bits = (bits ^ std::bit_cast<std::uint32_t>(v)) * 1099511628211u;
  }
  EXPECT_EQ(bits, 4419156568933841691u);
}

}  // namespace
}  // namespace zoneplate
