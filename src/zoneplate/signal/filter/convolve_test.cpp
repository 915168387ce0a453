// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/convolve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {
namespace {

constexpr Border all_borders[] = {Border::Clamp, Border::Reflect, Border::Wrap, Border::Zero};

Plane<float> seeded_plane(int w, int h, std::uint32_t seed = 5) {
  Plane<float> p(w, h);
  for (std::uint32_t i = 0; float& v : p.values()) v = unit_float(hash(i++, seed));
  return p;
}

LinearImage seeded_image(int w, int h) {
  LinearImage p(w, h);
  for (std::uint32_t i = 0; Linear & v : p.values()) {
    v = {unit_float(hash(i, 1)), unit_float(hash(i, 2)), unit_float(hash(i, 3)), unit_float(hash(i, 4))};
    ++i;
  }
  return p;
}

// Convolution by the definition, pixel by pixel, in double.
Plane<float> by_definition(const Plane<float>& plane, const Plane<float>& kernel, Border border) {
  Plane<float> out(plane.width(), plane.height());
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      double sum = 0;
      for (int j = 0; j < kernel.height(); ++j)
        for (int i = 0; i < kernel.width(); ++i) {
          const int from_x = border_index(x - (i - kernel.width() / 2), plane.width(), border);
          const int from_y = border_index(y - (j - kernel.height() / 2), plane.height(), border);
          if (from_x >= 0 && from_y >= 0)
            sum += static_cast<double>(kernel(i, j)) * static_cast<double>(plane(from_x, from_y));
        }
      out(x, y) = static_cast<float>(sum);
    }
  return out;
}

float max_difference(const Plane<float>& a, const Plane<float>& b) {
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
  float worst = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) worst = std::max(worst, std::abs(a.values()[i] - b.values()[i]));
  return worst;
}

TEST(Convolve, DirectAndFourierAreTheDefinitionForEveryBorder) {
  const Plane<float> plane = seeded_plane(37, 23);
  for (const auto& [kw, kh] : {std::pair{1, 1}, {3, 5}, {4, 2}, {1, 9}, {41, 3}, {50, 51}}) {
    Plane<float> kernel = seeded_plane(kw, kh, 9);
    double sum = 0;
    for (float v : kernel.values()) sum += static_cast<double>(v);
    for (float& v : kernel.values()) v = static_cast<float>(v / sum);
    for (Border border : all_borders) {
      const Plane<float> expected = by_definition(plane, kernel, border);
      EXPECT_LE(max_difference(convolve(plane, kernel, {.border = border}), expected), 1.3e-7f)
          << name_of(border) << kw << kh;
      EXPECT_LE(max_difference(convolve_by_fourier(plane, kernel, border), expected), 1.3e-7f)
          << name_of(border) << kw << kh;
    }
  }
}

TEST(Convolve, SeparableIsTheOuterProductForEveryBorder) {
  const Plane<float> plane = seeded_plane(101, 70);
  for (const char* name : {"gaussian:sigma=8", "box:width=2", "lanczos3:", "b-spline"}) {
    const std::string text = name;
    const auto rows = sampled(stretched(make_kernel(text.substr(0, text.size() - (text.back() == ':'))), 1.7));
    const auto columns = sampled(make_kernel("gaussian:sigma=1.5"));
    const Plane<float> kernel = outer_product(rows, columns);
    for (Border border : all_borders) {
      const auto separable = convolve_separable(plane, rows, columns, {.border = border});
      EXPECT_LE(max_difference(separable, convolve(plane, kernel, {.border = border})), 2e-6f) << name;
      EXPECT_LE(max_difference(separable, convolve_by_fourier(plane, kernel, border)), 2e-6f) << name;
    }
  }
}

TEST(Convolve, AKernelIsFlippedAndItsOriginIsInTheMiddle) {
  Plane<float> impulse(9, 5);
  impulse(4, 2) = 1;
  const Plane<float> kernel = seeded_plane(4, 3);
  for (const auto& out : {convolve(impulse, kernel), convolve_by_fourier(impulse, kernel)})
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) EXPECT_NEAR(out(4 - 2 + x, 2 - 1 + y), kernel(x, y), 1e-7);
  const double taps[] = {1, 2, 4, 8};
  const auto rows = convolve_separable(impulse, taps, std::vector<double>{1});
  EXPECT_EQ(rows(2, 2), 1.0f);
  EXPECT_EQ(rows(5, 2), 8.0f);
  const auto columns = convolve_separable(impulse, std::vector<double>{1}, taps);
  EXPECT_EQ(columns(4, 0), 1.0f);
  EXPECT_EQ(columns(4, 3), 8.0f);
}

TEST(Convolve, ColoursAreFilteredChannelByChannel) {
  const LinearImage image = seeded_image(33, 21);
  const auto rows = sampled(make_kernel("gaussian:sigma=2"));
  const auto columns = sampled(make_kernel("box:width=5"));
  const Plane<float> kernel = outer_product(rows, columns);
  for (Border border : all_borders) {
    const ConvolveOptions options{.border = border};
    const auto separable = convolve_separable(image, rows, columns, options);
    const auto direct = convolve(image, kernel, options);
    const auto by_fourier = convolve_by_fourier(image, kernel, border);
    for (float Linear::*channel : {&Linear::r, &Linear::g, &Linear::b, &Linear::a}) {
      const auto part = [&](const LinearImage& of) {
        Plane<float> out(of.width(), of.height());
        for (std::size_t i = 0; i < out.values().size(); ++i) out.values()[i] = of.values()[i].*channel;
        return out;
      };
      EXPECT_EQ(part(separable), convolve_separable(part(image), rows, columns, options));
      EXPECT_EQ(part(direct), convolve(part(image), kernel, options));
      EXPECT_EQ(part(by_fourier), convolve_by_fourier(part(image), kernel, border));
    }
  }
}

TEST(Convolve, GivesTheSameBitsOnEveryInstructionSetAndNumberOfThreads) {
  const Plane<float> plane = seeded_plane(131, 150);
  const LinearImage image = seeded_image(45, 67);
  const auto taps = sampled(make_kernel("gaussian:sigma=3"));
  const Plane<float> kernel = seeded_plane(5, 4);
  const ConvolveOptions options{.border = Border::Reflect};
  const auto expected = with_isa(Isa::Scalar, [&] { return convolve_separable(plane, taps, taps, options); });
  const auto expected_image = with_isa(Isa::Scalar, [&] { return convolve_separable(image, taps, taps, options); });
  const auto expected_direct = with_isa(Isa::Scalar, [&] { return convolve(plane, kernel, options); });
  const auto expected_fourier = convolve_by_fourier(plane, kernel, Border::Reflect);
  for (const Isa isa : supported_isas())
    for (int threads : {1, 2, 3, 7})
      with_isa(isa, [&] {
        with_threads(threads, [&] {
          EXPECT_EQ(convolve_separable(plane, taps, taps, options), expected);
          EXPECT_EQ(convolve_separable(image, taps, taps, options), expected_image);
          EXPECT_EQ(convolve(plane, kernel, options), expected_direct);
          EXPECT_EQ(convolve_by_fourier(plane, kernel, Border::Reflect), expected_fourier);
        });
      });
}

TEST(Convolve, WhatIsInTheRoomDoesNotMatter) {
  const Plane<float> plane = seeded_plane(150, 40);
  const auto taps = sampled(make_kernel("gaussian:sigma=2"));
  const std::vector<double> one = {1};
  for (const auto& [rows, columns] : {std::pair{taps, taps}, {one, taps}, {taps, one}}) {
    const auto expected = convolve_separable(plane, rows, columns);
    EXPECT_EQ(convolve_separable(plane, rows, columns, {}, Plane<float>(150, 40, 7)), expected);
    EXPECT_EQ(convolve_separable(plane, rows, columns, {}, Plane<float>(15, 40, 7)), expected);
  }
}

TEST(Convolve, OnePixelAndNone) {
  const double taps[] = {0.25, 0.5, 0.25};
  EXPECT_TRUE(convolve_separable(Plane<float>(), taps, taps).empty());
  EXPECT_TRUE(convolve(Plane<float>(), Plane<float>(1, 1, 1)).empty());
  EXPECT_TRUE(convolve_by_fourier(Plane<float>(), Plane<float>(1, 1, 1)).empty());
  for (Border border : all_borders)
    EXPECT_EQ(convolve_separable(Plane<float>(1, 1, 8), taps, taps, {.border = border})(0, 0),
              border == Border::Zero ? 2.0f : 8.0f);
}

TEST(Convolve, TheTheoremWithoutPaddingFailsAtTheBordersOfClampAndReflect) {
  const Plane<float> plane = seeded_plane(64, 48);
  const auto taps = sampled(make_kernel("gaussian:sigma=2"));
  const Plane<float> kernel = outer_product(taps, taps);
  const auto periodic = convolve_by_fourier(plane, kernel, Border::Wrap);
  for (Border border : {Border::Clamp, Border::Reflect, Border::Zero}) {
    const auto space = convolve(plane, kernel, {.border = border});
    EXPECT_GT(max_difference(space, periodic), 0.05f);
    const auto inner = [](const Plane<float>& p) { return cropped(p, 8, 8, 48, 32); };
    EXPECT_LT(max_difference(inner(space), inner(periodic)), 1e-6f);
  }
}

}  // namespace
}  // namespace zoneplate
