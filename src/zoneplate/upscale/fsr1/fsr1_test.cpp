// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr1/fsr1.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"

namespace zoneplate::upscale {
namespace {

/// The chart of other implementations, 64 × 64 to 96 × 96 pixels.
DisplayImage upscaled_chart(const Fsr1Options& options) {
  const Rgba8Image codes = antialias::chart64();
  DisplayImage chart(64, 64);
  for (std::size_t i = 0; i < chart.values().size(); ++i) {
    const Rgba8 c = codes.values()[i];
    chart.values()[i] = {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255,
                         1};
  }
  return upscale_fsr1(chart, {64, 64, 0, 0, {96, 96, std::nullopt}}, options);
}

Fsr1Options with_rcas(float stops, Reciprocals reciprocals = Reciprocals::Approximate) {
  Fsr1Options options;
  options.rcas.reciprocals = reciprocals;
  options.rcas.sharpness = std::exp2(-stops);
  return options;
}

double sum_of(const DisplayImage& image, int border) {
  double sum = 0;
  for (int y = border; y < image.height() - border; ++y)
    for (int x = border; x < image.width() - border; ++x) {
      const Display& c = image(x, y);
      sum += static_cast<double>(c.r) + static_cast<double>(c.g) + static_cast<double>(c.b);
    }
  return sum;
}

Fsr1Options without_rcas(Reciprocals reciprocals) { return {.sharpens = false, .rcas = {.reciprocals = reciprocals}}; }

// The sums are those of an implementation in double that agrees with three.js' FSR1Node.
TEST(Fsr1, AgreesWithFiguresOfAnotherImplementation) {
  const DisplayImage easu = upscaled_chart(without_rcas(Reciprocals::Exact));
  EXPECT_NEAR(sum_of(easu, 0), 15528.7821, 2e-3);
  EXPECT_NEAR(sum_of(easu, 4), 13399.0127, 2e-3);
  EXPECT_NEAR(easu(48, 20).g, 0.90522, 1e-5);
  EXPECT_NEAR(sum_of(upscaled_chart(without_rcas(Reciprocals::Approximate)), 0), 15529.8506, 2e-3);
  const DisplayImage sharp = upscaled_chart(with_rcas(0.2f, Reciprocals::Exact));
  EXPECT_NEAR(sum_of(sharp, 0), 15522.6649, 5e-3);
  EXPECT_NEAR(sharp(48, 20).r, 0.91731, 1e-5);
  EXPECT_NEAR(sharp(48, 20).g, 0.91726, 1e-5);
  EXPECT_NEAR(sharp(48, 20).b, 0.91692, 1e-5);
}

class Fsr1Golden : public testing::TestWithParam<std::string> {};

constexpr int side = 96;
std::vector<float> golden(const std::string& path) {
  std::vector<float> values(side * side * 3);
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  return values;
}

/// The second pass alone, of the first pass's image in three channels.
DisplayImage sharpened(const std::vector<float>& values, const RcasOptions& options) {
  DisplayImage bordered(side + 2, side + 2), out(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float* v = &values[static_cast<std::size_t>(3 * (side * y + x))];
      bordered(x + 1, y + 1) = {v[0], v[1], v[2], 1};
    }
  for (int y = 0; y < side; ++y) {
    const auto row = [&](int i) { return &bordered.row(y + i)[1].r; };
    RcasKernels::of().sharpen_row(row(0), row(1), row(2), options, &out.row(y).data()->r, side);
  }
  return out;
}

// Images that three.js r187 made: each pass stores half floats, and the second reads those of the first. Within four
// pixels of the sides it reads pixels beyond the image.
TEST_P(Fsr1Golden, AgreesWithThreeJs) {
  const std::string path = GetParam();
  const std::size_t name = path.find("rcas0.2_");
  const bool is_sharp = name != std::string::npos;
  const DisplayImage image = is_sharp ? sharpened(golden(std::string(path).replace(name, 8, "easu_")),
                                                  with_rcas(0.2f, Reciprocals::Exact).rcas)
                                      : upscaled_chart(without_rcas(Reciprocals::Exact));
  const std::vector<float> expected = golden(path);
  for (int y = 4; y < side - 4; ++y)
    for (int x = 4; x < side - 4; ++x) {
      const float* e = &expected[static_cast<std::size_t>(3 * (side * y + x))];
      ASSERT_NEAR(image(x, y).r, e[0], 2.5e-4) << x << " " << y;
      ASSERT_NEAR(image(x, y).g, e[1], 2.5e-4) << x << " " << y;
      ASSERT_NEAR(image(x, y).b, e[2], 2.5e-4) << x << " " << y;
    }
}
INSTANTIATE_TEST_SUITE_P(Shared, Fsr1Golden,
                         testing::ValuesIn(shared_files("methods/goldens", {"easu_96x96_rgb_f32_three187.bin",
                                                                            "rcas0.2_96x96_rgb_f32_three187.bin"})));
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Fsr1Golden);

TEST(Fsr1, IsAmdsUnlessThreeJsIsAskedFor) {
  const auto by_name = [](const char* method) {
    const Rgba8Image codes = antialias::chart64();
    DisplayImage chart(64, 64);
    std::ranges::transform(codes.values(), chart.values().begin(), [](Rgba8 c) {
      return Display{static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255, 1};
    });
    return make_spatial_upscaler(method)->upscale(chart, {64, 64, 0, 0, {96, 96, std::nullopt}});
  };
  const auto by_options = [](Reciprocals reciprocals) {
    Fsr1Options options = with_rcas(0, reciprocals);
    options.rcas.sharpness = exp2(-0.2f);
    return upscaled_chart(options);
  };
  EXPECT_EQ(by_name("fsr1"), by_options(Reciprocals::Approximate));
  EXPECT_EQ(by_name("fsr1:math=amd"), by_options(Reciprocals::Approximate));
  EXPECT_EQ(by_name("fsr1:math=three"), by_options(Reciprocals::Exact));
  EXPECT_NE(by_options(Reciprocals::Exact), by_options(Reciprocals::Approximate));
}

// Minima and maxima of 0 and -0 are the second operand on every instruction set, so that no bit depends on which of
// them an instruction takes for the lesser.
TEST(Fsr1, ZerosOfBothSignsHaveTheSameBitsOnEveryInstructionSet) {
  constexpr int count = 3 * 3 * 3 * 3 * 3;  // all pixels and neighbours of 0, -0 and 1
  DisplayImage rows[3] = {DisplayImage(count + 2, 1), DisplayImage(count + 2, 1), DisplayImage(count + 2, 1)};
  for (int i = 0, rest = 0; i < count + 2; ++i) {
    rest = i;
    for (DisplayImage& row : rows) {
      const auto value = [](int k) { return k % 3 == 0 ? 0.0f : k % 3 == 1 ? -0.0f : 1.0f; };
      row(i, 0) = {value(rest), value(rest / 3), value(rest / 9), value(rest / 27)};
      rest = static_cast<int>(hash(static_cast<std::uint32_t>(rest)) % 243);
    }
  }
  for (const bool is_unbounded : {false, true})
    for (const Reciprocals reciprocals : {Reciprocals::Approximate, Reciprocals::Exact}) {
      const RcasOptions options{.is_unbounded = is_unbounded, .denoises = true, .reciprocals = reciprocals};
      const auto bits_of = [&](Isa isa) {
        std::vector<std::uint32_t> bits(std::size_t{4} * count);
        with_isa(isa, [&] {
          RcasKernels::of().sharpen_row(&rows[0](1, 0).r, &rows[1](1, 0).r, &rows[2](1, 0).r, options,
                                        reinterpret_cast<float*>(bits.data()), count);
        });
        return bits;
      };
      for (const Isa isa : supported_isas()) EXPECT_EQ(bits_of(isa), bits_of(Isa::Scalar)) << name_of(isa);
    }
  using F = scalar::Float;
  EXPECT_TRUE(std::signbit(min(F(0.0f), F(-0.0f)).v) && std::signbit(max(F(0.0f), F(-0.0f)).v));
  EXPECT_FALSE(std::signbit(min(F(-0.0f), F(0.0f)).v) || std::signbit(max(F(-0.0f), F(0.0f)).v));
}

TEST(Fsr1, SharpeningStaysInRangeAndOrder) {
  const DisplayImage soft = upscaled_chart(with_rcas(2)), sharp = upscaled_chart(with_rcas(0));
  const DisplayImage easu = upscaled_chart({.sharpens = false});
  double soft_change = 0, sharp_change = 0;
  for (std::size_t i = 0; i < easu.values().size(); ++i) {
    soft_change += std::abs(static_cast<double>(soft.values()[i].g - easu.values()[i].g));
    sharp_change += std::abs(static_cast<double>(sharp.values()[i].g - easu.values()[i].g));
  }
  EXPECT_GT(soft_change, 0);
  EXPECT_GT(sharp_change, 2 * soft_change);
}

}  // namespace
}  // namespace zoneplate::upscale
