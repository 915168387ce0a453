// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "zoneplate/antialias/reference/analytic/flat_triangles_for_test.h"
#include "zoneplate/antialias/reference/converged/pattern.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

/// Intersecting triangles in several colours.
FlatTriangles some_scene(int side) {
  Numbers random(9);
  FlatTriangles scene(side, side);
  for (int i = 0; i < 12; ++i) {
    FlatCorner c[3];
    for (FlatCorner& p : c) p = {random(-4, side + 4), random(-4, side + 4), static_cast<float>(random(0.1, 0.9))};
    const auto channel = [&] { return static_cast<float>(random(0, 1)); };
    scene.add(c[0], c[1], c[2], {channel(), channel(), channel(), 1});
  }
  return scene;
}

double rms_between(const LinearImage& p, const LinearImage& q) {
  double squares = 0;
  for (std::size_t i = 0; i < p.values().size(); ++i) {
    const Linear a = p.values()[i], b = q.values()[i];
    for (const float off : {a.r - b.r, a.g - b.g, a.b - b.b, a.a - b.a}) squares += static_cast<double>(off) * off;
  }
  return std::sqrt(squares / static_cast<double>(4 * p.values().size()));
}

TEST(ConvergedPattern, EveryRunIsStratified) {
  const SamplePattern pattern = scrambled_pattern(1024);
  for (std::size_t first = 0; first < 1024; first += 64)
    for (const int columns : {8, 16, 4}) {
      // One position in each of 64 boxes; rounding moves some across a border by half a step, so that the test has a
      // tolerance.
      std::vector<int> count(64);
      const int rows = 64 / columns;
      for (std::size_t i = first; i < first + 64; ++i)
        ++count[static_cast<std::size_t>(pattern[i].x * columns / 256 * rows + pattern[i].y * rows / 256)];
      int off = 0;
      for (const int c : count) off += std::abs(c - 1);
      EXPECT_LE(off, 12) << first << " " << columns;
    }
  double x = 0, y = 0;
  for (const SamplePosition p : pattern) x += p.x, y += p.y;
  EXPECT_NEAR(x / 1024, 128, 0.1);
  EXPECT_NEAR(y / 1024, 128, 0.1);
  EXPECT_NE(scrambled_pattern(64, 1), scrambled_pattern(64, 2));
}

TEST(Converged, ComesToTheExactPictureUnderEveryFilter) {
  const FlatTriangles scene = some_scene(32);
  for (const char* filter : {"box", "tent", "quadratic", "b-spline", "mitchell", "catmull-rom"}) {
    const LinearImage exact = scene.analytic({.filter = filter});
    const double coarse = rms_between(scene.converged({.samples = 64, .filter = filter}), exact);
    const double fine = rms_between(scene.converged({.samples = 1024, .filter = filter}), exact);
    EXPECT_LT(fine, 1.5e-3) << filter;
    EXPECT_LT(fine, 0.3 * coarse) << filter;
  }
}

TEST(Converged, ItsEstimateIsNearItsErrorAndNotBelow) {
  const FlatTriangles scene = some_scene(64);
  const LinearImage exact = scene.analytic();
  for (const int samples : {64, 256}) {
    Plane<float> error;
    const LinearImage image = scene.converged({.samples = samples}, &error);
    // The greatest error of the channels, as in the estimate.
    double squares = 0, estimated = 0;
    for (std::size_t i = 0; i < exact.values().size(); ++i) {
      const Linear p = image.values()[i], q = exact.values()[i];
      double greatest = 0;
      for (const float off : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a})
        greatest = std::max(greatest, static_cast<double>(off) * off);
      squares += greatest;
      estimated += static_cast<double>(error.values()[i]) * error.values()[i];
    }
    EXPECT_LT(std::sqrt(squares), 1.1 * std::sqrt(estimated)) << samples;
    EXPECT_GT(std::sqrt(squares), 0.3 * std::sqrt(estimated)) << samples;
  }
}

TEST(Converged, ThreadsAndCropsLeaveNoTrace) {
  const FlatTriangles scene = some_scene(64);
  const ConvergedOptions options{.samples = 64, .filter = "mitchell"};
  const LinearImage image = scene.converged(options);
  for (const int threads : {1, 2, 3, 7})
    with_threads(threads, [&] { EXPECT_TRUE(same_bits(scene.converged(options), image)) << threads; });
  const Crop crop{5, 33, 50, 20};
  const LinearImage part = scene.converged(options, nullptr, crop);
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x) ASSERT_EQ(part(x, y), image(crop.x + x, crop.y + y));
}

TEST(Converged, BothTruthsOfBrightEdges) {
  FlatTriangles scene(8, 8);
  scene.add_quad({0, 0}, {8, 0}, {8, 8}, {0, 8}, {0.2f, 0.2f, 0.2f, 1});
  scene.add_quad({0, 0, 0.6f}, {3.5, 0, 0.6f}, {3.5, 8, 0.6f}, {0, 8, 0.6f}, {10, 10, 10, 1});
  EXPECT_NEAR(scene.converged({.samples = 1024})(3, 3).r, 5.1, 0.05);
  EXPECT_NEAR(scene.converged({.samples = 1024, .order = FilterOrder::Display})(3, 3).r, 0.6, 0.005);
}

}  // namespace
}  // namespace zoneplate::antialias
