// SPDX-License-Identifier: Apache-2.0
// The areas under revectorised edges in closed form, against numeric integrals and against the area tables.
#include "zoneplate/antialias/post/smaa/exact_areas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/antialias/post/smaa/tables.h"
#include "zoneplate/math/random.h"

namespace zoneplate::antialias {
namespace {

constexpr float2 offsets[] = {{0, 0},           {0.25f, -0.25f}, {-0.375f, 0.125f}, {0.5f, 0.5f},
                              {-0.5f, 0.3125f}, {0.11f, 0},      {0, -0.43f}};

AreaPair orthogonal(int from, int to, int left, int right, float2 offset, bool is_corner = false) {
  const float f = static_cast<float>(from), t = static_cast<float>(to);
  const float l = static_cast<float>(left), r = static_cast<float>(right), c = is_corner ? 1.0f : 0.0f;
  float below = 0, above = 0;
  AreaKernels::of().orthogonal({&f, &t, &l, &r, &c}, offset, &below, &above, 1);
  return {below, above};
}

AreaPair diagonal(int left_code, int right_code, int left, int right, float2 offset) {
  const std::int32_t lines = diagonal_lines_of(left_code, right_code);
  const float l = static_cast<float>(left), r = static_cast<float>(right);
  float below = 0, above = 0;
  AreaKernels::of().diagonal({&lines, &l, &r}, offset, &below, &above, 1);
  return {below, above};
}

/// The mean of a function over `count` points of [0, 1].
template <class Function>
double mean_of(int count, const Function& function) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += function((i + 0.5) / count);
  return sum / count;
}

// A step is the line between its ends, wherever the samples are; the pixels' columns are displaced against it.
TEST(ExactAreas, StepsHaveTheAreasOfTheirLines) {
  for (const float2 o : offsets)
    for (const int direction : {1, -1})
      for (const int length : {1, 2, 3, 7, 40, 200})
        for (int left = 0; left < length; left += std::max(1, length / 9)) {
          const AreaPair a = orthogonal(direction, -direction, left, length - 1 - left, o);
          const auto height = [&](double x) { return static_cast<double>(o.y) + direction * (0.5 - x / length); };
          const auto at = [&](double x) { return height(left + x - static_cast<double>(o.x)); };
          const auto clamped = [](double y) { return std::clamp(y, 0.0, 1.0); };
          ASSERT_NEAR(a.above, mean_of(4000, [&](double x) { return clamped(at(x)); }), 1e-5) << length << " " << left;
          ASSERT_NEAR(a.below, mean_of(4000, [&](double x) { return clamped(-at(x)); }), 1e-5) << length << " " << left;
        }
}

// One crossing edge: a line to the middle of the edge, which keeps the border. Two on one side: a rounded U shape,
// which is displaced as a whole where it is short and has no corner.
TEST(ExactAreas, OtherShapesMeetInTheMiddle) {
  for (const float2 o : offsets)
    for (const int side : {1, -1})
      for (const auto& [is_u, is_corner] : {std::pair{false, false}, std::pair{true, false}, std::pair{true, true}})
        for (const int length : {1, 2, 5, 8, 31, 60})
          for (int left = 0; left < length; left += std::max(1, length / 9)) {
            const AreaPair a = orthogonal(side, is_u ? side : 0, left, length - 1 - left, o, is_corner);
            const double half = length * 0.5, share = std::min(length / 32.0, 1.0);
            const double end = side * 0.5 + static_cast<double>(o.y);
            const double is_free = is_u && !is_corner ? 1 : 0, across = static_cast<double>(o.y);
            const double middle = is_free * across * (1 - share);
            const double plain = 1 - (1 - share) * (1 - is_free * std::min(8 * std::abs(across), 1.0));
            // The integrals of one half; `sign` chooses those above or below the border.
            const auto integral = [&, is_u = is_u](bool is_first, double sign) {
              return mean_of(2000, [&](double x) {
                const double from_middle = left + x - static_cast<double>(o.x) - half;
                if ((from_middle < 0) != is_first) return 0.0;
                if (!is_first && !is_u) return 0.0;
                return std::clamp(sign * (middle + (end - middle) * std::abs(from_middle) / half), 0.0, 1.0);
              });
            };
            const auto rounded = [&, is_u = is_u](double area) {
              if (!is_u) return area;
              const double round = std::sqrt(2 * area) / 2;
              return round + (area - round) * plain;
            };
            const auto expected = [&](double sign) {
              return rounded(integral(true, sign)) + rounded(integral(false, sign));
            };
            // The numeric integral of a half that ends within a step of its points is wrong by that step.
            ASSERT_NEAR(a.above, expected(1), 3e-3) << side << is_u << length << " " << left;
            ASSERT_NEAR(a.below, expected(-1), 3e-3) << side << is_u << length << " " << left;
          }
}

// The fractions of the two pixels beside each line of a pattern, by a grid of points.
TEST(ExactAreas, DiagonalsHaveTheAreasOfTheirLines) {
  for (const float2 o : offsets)
    for (int codes = 0; codes < 16; ++codes)
      for (const int length : {4, 9})
        for (const int left : {0, 1, length - 1}) {
          const AreaPair a = diagonal(codes / 4, codes % 4, left, length - 1 - left, o);
          const std::int32_t lines = diagonal_lines_of(codes / 4, codes % 4);
          double below = 0, above = 0;
          for (const int shift : {0, 4}) {
            const auto bit = [&](int i) { return lines >> (shift + i) & 1; };
            const double x0 = bit(0) + static_cast<double>(o.x), y0 = bit(1) + static_cast<double>(o.y);
            const double x1 = bit(2) + length + static_cast<double>(o.x);
            const double y1 = bit(3) + length + static_cast<double>(o.y);
            const auto share = [&](int row) {
              constexpr int points = 80;
              return mean_of(points, [&](double u) {
                return mean_of(points, [&](double v) {
                  const double x = 1 + left + u, y = left + row + v;
                  return (y1 - y0) * (x - x0) - (x1 - x0) * (y - y0) > 0 ? 1.0 : 0.0;
                });
              });
            };
            below += (1 - share(0)) / 2, above += share(1) / 2;
          }
          ASSERT_NEAR(a.below, below, 1e-2) << codes << " " << left;
          ASSERT_NEAR(a.above, above, 1e-2) << codes << " " << left;
        }
}

// At the centre the areas are those that the generator of the tables has before it rounds them; its diagonals count the
// points of a grid that includes the pixel's border.
TEST(ExactAreas, CentredSamplesHaveTheAreasOfTheTables) {
  for (int pattern = 0; pattern < 16; ++pattern) {
    const auto side = [&](int down, int up) { return (pattern & up ? 1 : 0) - (pattern & down ? 1 : 0); };
    const int first = side(left_down, left_up), last = side(right_down, right_up);
    const bool is_both_left = (pattern & 5) == 5, is_both_right = (pattern & 10) == 10;
    for (int left = 0; left < 40; ++left)
      for (int right = 0; right < 40; ++right) {
        const AreaPair a = orthogonal(is_both_left ? -last : first, is_both_right ? -first : last, left, right, {0, 0});
        const AreaPair b = orthogonal_area(pattern, left, right, 0, true);
        ASSERT_NEAR(a.below, b.below, 2e-4) << pattern << " " << left << " " << right;
        ASSERT_NEAR(a.above, b.above, 2e-4) << pattern << " " << left << " " << right;
      }
  }
  constexpr int codes[16][2] = {{0, 0}, {1, 0}, {0, 2}, {1, 2}, {2, 0}, {3, 0}, {2, 2}, {3, 2},
                                {0, 1}, {1, 1}, {0, 3}, {1, 3}, {2, 1}, {3, 1}, {2, 3}, {3, 3}};
  for (int pattern = 0; pattern < 16; ++pattern)
    for (int left = 0; left < 20; ++left)
      for (int right = left == 0 ? 2 : 0; right < 20; ++right) {
        const AreaPair a = diagonal(codes[pattern][0], codes[pattern][1], left, right, {0, 0});
        const AreaPair b = diagonal_area(pattern, left, right, 0, 0);
        ASSERT_NEAR(a.below, b.below, 0.05) << pattern << " " << left << " " << right;
        ASSERT_NEAR(a.above, b.above, 0.05) << pattern << " " << left << " " << right;
      }
}

TEST(ExactAreas, KernelsComputeWhatTheirTwinsCompute) {
  constexpr std::size_t most = 200;
  std::vector<float> from(most), to(most), left(most), right(most), corner(most);
  std::vector<std::int32_t> lines(most);
  std::uint32_t seed = 0;
  const auto random = [&](int count) { return static_cast<int>(hash(seed++) >> 8) % count; };
  for (std::size_t i = 0; i < most; ++i) {
    from[i] = static_cast<float>(random(3) - 1), to[i] = static_cast<float>(random(3) - 1);
    left[i] = static_cast<float>(random(i % 2 ? 4 : 120)), right[i] = static_cast<float>(2 + random(i % 3 ? 5 : 120));
    corner[i] = static_cast<float>(random(2));
    lines[i] = diagonal_lines_of(random(4), random(4));
  }
  for (const Isa isa : supported_isas())
    for (const float2 offset : offsets)
      for (std::size_t n = 0; n <= most; n += n < 20 ? 1 : 45) {
        const auto compute = [&](const AreaKernels& kernels) {
          std::vector<float> out(4 * (n + 1), 9);
          kernels.orthogonal({from.data(), to.data(), left.data(), right.data(), corner.data()}, offset, &out[0],
                             &out[n + 1], n);
          kernels.diagonal({lines.data(), left.data(), right.data()}, offset, &out[2 * n + 2], &out[3 * n + 3], n);
          return out;
        };
        ASSERT_EQ(compute(AreaKernels::of(isa)), compute(AreaKernels::scalar)) << name_of(isa) << n;
      }
}

}  // namespace
}  // namespace zoneplate::antialias
