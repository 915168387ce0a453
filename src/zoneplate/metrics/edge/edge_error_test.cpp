// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/edge/edge_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace zoneplate::metrics {
namespace {

EdgeError edge_error_of(const DisplayImage& reference, const DisplayImage& test) {
  return measure_edge_error(make_picture(reference), make_picture(test));
}

/// A bright half-plane with box-filtered pixels whose edge has this angle; partially covered pixels are too bright by
/// `off`.
DisplayImage half_plane(double degrees, bool is_upright, float off = 0) {
  const double a = degrees * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
  DisplayImage out(80, 80);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 80; ++x) {
      int inside = 0;
      for (int k = 0; k < 256; ++k) {
        double u = x + (k % 16 + 0.5) / 16 - 40, v = y + (k / 16 + 0.5) / 16 - 40;
        if (is_upright) std::swap(u, v);
        inside += v * c - u * s > 0.3;
      }
      const float share = static_cast<float>(inside) / 256;
      const float code = 0.1f + 0.7f * share + (share > 0 && share < 1 ? off : 0);
      out(x, y) = {code, code, code, 1};
    }
  return out;
}

TEST(EdgeError, EveryAngleFallsIntoItsBin) {
  for (const bool is_upright : {false, true})
    for (const double degrees : {1.0, 7.0, 12.0, 22.0, 33.0, 38.0, 44.0}) {
      const EdgeError error = edge_error_of(half_plane(degrees, is_upright), half_plane(degrees, is_upright));
      std::uint64_t all = 0, near = 0;
      const int own = static_cast<int>(degrees / 5);
      for (int i = 0; i < EdgeError::bins; ++i) {
        all += error.by_angle[static_cast<std::size_t>(i)].pixels;
        if (std::abs(i - own) <= 1) near += error.by_angle[static_cast<std::size_t>(i)].pixels;
      }
      EXPECT_GE(all, 76u) << degrees;
      EXPECT_GE(near, all * 95 / 100) << degrees;
      EXPECT_EQ(error.rms(), 0.0);
    }
}

TEST(EdgeError, AKnownErrorIsFound) {
  // Pixels on the edge have an error of 0.1; the adjacent ones, which are also on the gradient, have none.
  const EdgeError error = edge_error_of(half_plane(22, false), half_plane(22, false, 0.1f));
  const double rms = error.rms().value();
  EXPECT_GT(rms, 0.06);
  EXPECT_LT(rms, 0.1);
}

TEST(EdgeError, WhereThereIsNoEdgeThereIsNoAnswer) {
  DisplayImage flat(40, 30, Display{0.5f, 0.5f, 0.5f, 1}), checks(40, 30);
  EXPECT_FALSE(edge_error_of(flat, flat).rms().has_value());
  // A gradient without a dominant direction is not an edge.
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const float code = (x / 2 + y / 2) % 2 ? 0.9f : 0.1f;
      checks(x, y) = {code, code, code, 1};
    }
  EXPECT_FALSE(edge_error_of(checks, checks).rms().has_value());
}

}  // namespace
}  // namespace zoneplate::metrics
