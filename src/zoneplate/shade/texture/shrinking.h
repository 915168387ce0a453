// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "zoneplate/image/half.h"
#include "zoneplate/shade/texture/texture_view.h"

/// Rows of texels, and rows of half their size, for texels of every type.
namespace zoneplate {

/// The number of rows that a thread takes at once.
inline constexpr std::size_t texel_rows_per_range = 32;

/// The size of an image in texels.
struct LevelSize {
  std::int32_t width, height;
  bool operator==(const LevelSize&) const = default;
};

/// A sum of weighted texels, and its mean: exact for unorm texels, rounded to the nearest.
template <class Code>
using TexelSum = std::conditional_t<std::is_integral_v<Code>, std::uint64_t, double>;

/// The texel as a term of a sum.
template <class Code>
Code term(Code code) {
  return code;
}
inline float term(Half half) { return half_value(half.bits); }

/// A mean as a texel of floats or half floats.
template <class Code>
Code rounded(double mean) {
  if constexpr (std::is_same_v<Code, Half>)
    return {half_bits(static_cast<float>(mean))};
  else
    return static_cast<Code>(mean);
}

template <class Code>
Code mean_of(TexelSum<Code> sum, std::uint64_t total) {
  if constexpr (std::is_integral_v<Code>)
    return static_cast<Code>((sum + total / 2) / total);
  else
    return rounded<Code>(sum / static_cast<double>(total));
}

/// The texels of one axis that a texel of a smaller image covers: `count` of them from `first`, by integer weights.
struct TexelCover {
  std::int32_t first, count;
  std::uint64_t weight[3];
};

/// The texels along an axis of n texels that is reduced to `to` texels: n, or n / 2 rounded down. The weights add up to
/// `total_weight(n, to)`.
inline TexelCover cover(std::int32_t n, std::int32_t to, std::int32_t i) {
  if (n == to) return {i, 1, {1, 0, 0}};
  if (n % 2 == 0) return {2 * i, 2, {1, 1, 0}};
  const std::int32_t half = n / 2;
  return {2 * i,
          3,
          {static_cast<std::uint64_t>(half - i), static_cast<std::uint64_t>(half), static_cast<std::uint64_t>(i + 1)}};
}

inline std::uint64_t total_weight(std::int32_t n, std::int32_t to) {
  return n == to ? 1 : n % 2 == 0 ? 2 : static_cast<std::uint64_t>(n);
}

/// Fills the border of a row with copies of its last and its first texel.
template <class Code>
void close_row(Code* row, std::int32_t width) {
  std::copy_n(row, 4, row + std::ptrdiff_t{4} * width);
  std::copy_n(row + std::ptrdiff_t{4} * (width - 1), 4, row - 4);
}

/// Fills the border above and below a level, whose rows have theirs, with copies of its last and its first row.
template <class Code>
void close_level(Code* codes, const TextureView& view, int l) {
  const std::ptrdiff_t pitch = std::ptrdiff_t{4} * view.pitch(l);
  Code* const level = codes + std::ptrdiff_t{4} * view.offset[l];
  std::copy_n(level + pitch * view.height[l], pitch, level);
  std::copy_n(level + pitch, pitch, level + pitch * (view.height[l] + 1));
}

/// Texel (0, y) of a level.
template <class Code>
Code* row_of(Code* codes, const TextureView& view, int l, std::int32_t y) {
  return codes + std::ptrdiff_t{4} * view.texel(l, 0, y);
}

/// Both sizes even: the mean of four.
template <class Code>
void halve_row(const Code* upper, const Code* lower, std::int32_t out_width, Code* out) {
  using Four = std::conditional_t<std::is_integral_v<Code>, std::uint32_t, double>;
  for (std::int32_t x = 0; x < out_width; ++x)
    for (int c = 0; c < 4; ++c) {
      const std::ptrdiff_t at = std::ptrdiff_t{8} * x + c;
      const Four sum = Four{term(upper[at])} + term(upper[at + 4]) + term(lower[at]) + term(lower[at + 4]);
      if constexpr (std::is_integral_v<Code>)
        out[std::ptrdiff_t{4} * x + c] = static_cast<Code>((sum + 2) >> 2);
      else
        out[std::ptrdiff_t{4} * x + c] = rounded<Code>(sum * 0.25);
    }
}

/// Any size: row y of the smaller image, as weighted means of the rows that it covers.
template <class Code>
void shrink_row(const std::array<const Code*, 3>& source, const TexelCover& rows, LevelSize from, LevelSize to,
                Code* out) {
  const std::uint64_t total = total_weight(from.width, to.width) * total_weight(from.height, to.height);
  for (std::int32_t x = 0; x < to.width; ++x) {
    const TexelCover columns = cover(from.width, to.width, x);
    for (int c = 0; c < 4; ++c) {
      TexelSum<Code> sum = 0;
      for (std::size_t j = 0; j < static_cast<std::size_t>(rows.count); ++j)
        for (std::int32_t i = 0; i < columns.count; ++i)
          sum += static_cast<TexelSum<Code>>(rows.weight[j] * columns.weight[i]) *
                 term(source[j][std::ptrdiff_t{4} * (columns.first + i) + c]);
      out[std::ptrdiff_t{4} * x + c] = mean_of<Code>(sum, total);
    }
  }
}

/// The rows that row y of the smaller image covers, each as `row(y, its index among them)`.
template <class Code, class Row>
std::array<const Code*, 3> covered_rows(const TexelCover& rows, const Row& row) {
  std::array<const Code*, 3> source{};
  for (std::int32_t j = 0; j < rows.count; ++j) source[static_cast<std::size_t>(j)] = row(rows.first + j, j);
  return source;
}

}  // namespace zoneplate
