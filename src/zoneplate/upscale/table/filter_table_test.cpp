// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/table/filter_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/hash_for_test.h"
#include "zoneplate/math/random.h"
#include "zoneplate/network/trained.h"
#include "zoneplate/upscale/taau/taau_frames_for_test.h"
#include "zoneplate/upscale/table/learned_table.h"

namespace zoneplate::upscale {
namespace {

/// Noise of a few pixels' size, above 0.2 so that no filter is clamped at black.
LinearImage noise(int width, int height, std::uint32_t seed) {
  LinearImage out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](std::uint32_t c) {
        const auto cell = [&](int u, int v) {
          return unit_float(hash(static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v), seed + c));
        };
        const float fx = static_cast<float>(x % 3) / 3, fy = static_cast<float>(y % 3) / 3;
        const float above = cell(x / 3, y / 3) * (1 - fx) + cell(x / 3 + 1, y / 3) * fx;
        const float below = cell(x / 3, y / 3 + 1) * (1 - fx) + cell(x / 3 + 1, y / 3 + 1) * fx;
        return 0.2f + 0.6f * (above * (1 - fy) + below * fy);
      };
      out(x, y) = {at(0), at(1), at(2), 1};
    }
  return out;
}

Plane<std::uint8_t> halves(int width, int height) {
  Plane<std::uint8_t> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = x < width / 2 ? 0 : 1;
  return out;
}

/// The mean of the square roots of a pixel and its neighbours on one axis: within the extremes of 3 × 3 pixels.
LinearImage blurred(const LinearImage& image, bool is_across) {
  LinearImage out(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const auto root = [&](int k, float Linear::*c) {
        return std::sqrt(image(std::clamp(x + (is_across ? k : 0), 0, image.width() - 1),
                               std::clamp(y + (is_across ? 0 : k), 0, image.height() - 1)).*
                         c);
      };
      const auto mean = [&](float Linear::*c) {
        const float value = 0.25f * root(-1, c) + 0.5f * root(0, c) + 0.25f * root(1, c);
        return value * value;
      };
      out(x, y) = {mean(&Linear::r), mean(&Linear::g), mean(&Linear::b), 1};
    }
  return out;
}

/// A table that blurs group 0 across and group 1 downwards, the more exactly, the more images it is made of.
std::vector<std::uint8_t> blurring_table(int side = 5, std::uint32_t images = 6) {
  TableFit fit({2, side});
  for (std::uint32_t seed = 0; seed < images; ++seed) {
    const LinearImage image = noise(90, 70, 100 * seed);
    fit.add(image, Plane<std::uint8_t>(90, 70, std::uint8_t{0}), blurred(image, true));
    fit.add(image, Plane<std::uint8_t>(90, 70, std::uint8_t{1}), blurred(image, false));
  }
  return fit.bytes();
}

TEST(FilterTable, LeastSquaresFindTheFilterOfEachGroup) {
  const LinearImage image = noise(80, 60, 7777), across = blurred(image, true), down = blurred(image, false);
  for (const int side : {3, 5}) {
    const FilterTable table(blurring_table(side, 150), {2, side}, "test");
    const LinearImage out = filtered(image, table, halves(80, 60));
    double error = 0, before = 0;
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x) {
        const Linear& expected = (x < 40 ? across : down)(x, y);
        error += std::pow(double{out(x, y).g} - double{expected.g}, 2);
        before += std::pow(double{image(x, y).g} - double{expected.g}, 2);
      }
    EXPECT_LT(error, 0.003 * before) << side;
  }
}

TEST(FilterTable, ImagesCountByTheirWeight) {
  const LinearImage image = noise(90, 70, 1), truth = blurred(image, true);
  const Plane<std::uint8_t> group(90, 70, std::uint8_t{0});
  TableFit once({2, 3}), twice({2, 3}), weighted({2, 3});
  once.add(image, group, truth);
  twice.add(once, 1), twice.add(once, 1), weighted.add(once, 2);
  EXPECT_EQ(twice.bytes(), weighted.bytes());
  EXPECT_NE(once.bytes(), weighted.bytes());
  double expected = 0;
  for (std::size_t i = 0; i < image.values().size(); ++i)
    for (float Linear::*const c : {&Linear::r, &Linear::g, &Linear::b})
      expected += std::pow(std::sqrt(double{image.values()[i].*c}) - std::sqrt(double{truth.values()[i].*c}), 2);
  expected /= 3 * 90 * 70;
  // Square roots are rounded to floats.
  EXPECT_NEAR(once.error(), expected, 1e-6 * expected);
  EXPECT_NEAR(weighted.error(), expected, 1e-6 * expected);
}

TEST(FilterTable, ItsBytesAreTheSameOnEveryInstructionSet) {
  const std::vector<std::uint8_t> expected = with_isa(Isa::Scalar, [] { return blurring_table(); });
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] { with_threads(3, [&] { EXPECT_EQ(blurring_table(), expected) << name_of(isa); }); });
  Rgba8Image pixels(static_cast<int>(expected.size() / sizeof(Rgba8)), 1);
  std::memcpy(pixels.values().data(), expected.data(), pixels.values().size_bytes());
  EXPECT_EQ(hash_of(pixels), 0xe1715aa4c771a586u);
}

TEST(FilterTable, SameBitsOnEveryInstructionSetAndThreadCount) {
  for (const int side : {3, 5}) {
    const FilterTable table(blurring_table(side), {2, side}, "test");
    for (const auto& size : {std::pair(67, 41), std::pair(1, 1), std::pair(2, 9)}) {
      const int w = size.first, h = size.second;
      const LinearImage image = noise(w, h, 3);
      const LinearImage expected = with_isa(Isa::Scalar, [&] { return filtered(image, table, halves(w, h)); });
      for (const Isa isa : supported_isas())
        with_isa(isa, [&] {
          with_threads(3, [&] { EXPECT_EQ(filtered(image, table, halves(w, h)), expected) << name_of(isa) << w; });
        });
    }
  }
}

TEST(FilterTable, ResultsAreWithinTheNeighboursAndOneColourStays) {
  const FilterTable table(network::trained_weights(network::Trained::Table), CountGroups::form, "the program's own");
  const LinearImage image = noise(50, 40, 5);
  for (std::uint8_t group = 0; group < CountGroups::form.groups; ++group) {
    const LinearImage out = filtered(image, table, Plane<std::uint8_t>(50, 40, group));
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 50; ++x) {
        float low = 1, high = 0;
        for (int k = 0; k < 9; ++k) {
          const float v = image(std::clamp(x + k % 3 - 1, 0, 49), std::clamp(y + k / 3 - 1, 0, 39)).r;
          low = std::min(low, v), high = std::max(high, v);
        }
        ASSERT_TRUE(out(x, y).r >= low * 0.99999f && out(x, y).r <= high * 1.00001f) << x << ',' << y;
      }
    const Linear constant{0.3f, 7, 0, 1};
    const LinearImage flat = filtered(LinearImage(9, 8, constant), table, Plane<std::uint8_t>(9, 8, group));
    for (const Linear& c : flat.values()) ASSERT_EQ(c, constant);
  }
}

std::string table_refusal(std::span<const std::uint8_t> bytes) {
  try {
    FilterTable(bytes, {2, 5}, "t.bin");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    return e.what();
  }
  return "accepted";
}

TEST(FilterTable, ReadsNoOtherFiles) {
  std::vector<std::uint8_t> bytes = blurring_table();
  EXPECT_EQ(table_refusal(bytes), "accepted");
  EXPECT_EQ(table_refusal(std::span(bytes).first(100)), "t.bin: table of filters: has 100 bytes, expected 5384");
  EXPECT_EQ(table_refusal({}), "t.bin: table of filters: has 0 bytes, expected 5384");
  bytes[11] = 0x7f, bytes[10] = 0xc0;  // NaN
  EXPECT_EQ(table_refusal(bytes), "t.bin: table of filters: a scale is not in [0, 1)");
  bytes[0] = 'X';
  EXPECT_EQ(table_refusal(bytes), "t.bin: table of filters: does not begin with ZPTABLE1");
}

// What learned-table is for: wires that a frame's samples miss have less error than those of taau.
TEST(LearnedTable, ImprovesOnTaau) {
  using namespace taau_frames;
  const LightAt wires = [](double x, double y, int) {
    const double place = x + 0.37 * y;
    return std::abs(place - 5 * std::floor(place / 5) - 2.5) < 0.4 ? 0.9 : 0.1;
  };
  const float2 motion{0.37f, 0.11f};
  EXPECT_LT(error_after<TableMean>(16, wires, motion), 0.9 * error_after<SampleMean>(16, wires, motion));
}

}  // namespace
}  // namespace zoneplate::upscale
