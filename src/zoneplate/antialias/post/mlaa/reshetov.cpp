// SPDX-License-Identifier: Apache-2.0
// The original morphological antialiasing: separation lines of any length, in L, Z and U shapes.
//
// A Z or U shape is split at its middle into two L shapes; each L is a triangle from a height on the step at its end to
// the middle (for a single L, to the far end). The height is chosen so that the blended colours of both sides are
// equal. Lines of both directions are detected in the original image, not in each other's result.
//
// Source: Reshetov, Morphological Antialiasing, HPG 2009.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/mlaa/edge_detection.h"
#include "zoneplate/antialias/post/mlaa/mlaa.h"

namespace zoneplate {
namespace antialias {

float split_height(int near, int across, int beyond, int beyond_near) {
  const int numerator = beyond_near - near, denominator = across - near - beyond + beyond_near;
  if (denominator == 0) return 0.5f;
  const float h = static_cast<float>(numerator) / static_cast<float>(denominator);
  return h >= 0 && h <= 1 ? h : 0.5f;
}

namespace {

/// A difference in the upper four bits of a channel.
constexpr int min_difference = 16;

EdgePlane find_edges(const Rgba8Image& image) {
  const MlaaKernels& kernels = MlaaKernels::of();
  EdgePlane edges(image.width(), image.height(), 1);
  for_rows(image.height(), [&](int y) {
    const auto row = image.row(y), above = image.row(std::max(y - 1, 0));
    kernels.edges_row(&above[0].r, &row[0].r, min_difference, edges.at(0, y), row.size());
  });
  edges.extend();
  return edges;
}

constexpr std::uint64_t ones = 0x0101010101010101;

/// A mask of eight pixels that has the bit of `edge` in the byte of each pixel with that edge.
std::uint64_t edges_of_eight(const std::uint8_t* pixels, std::uint8_t edge) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, pixels, sizeof eight);
  return eight & edge * ones;
}

/// The same mask as eight consecutive bits, the first pixel in the lowest.
std::uint64_t bits_of_eight(const std::uint8_t* pixels) {
  constexpr std::uint64_t gather = 0x0102040810204080;
  return edges_of_eight(pixels, left_edge) * gather >> 56;
}

enum class Side { None, Below, Above };

/// The separation lines of one direction: `i` runs along them, `j` across; horizontal ones are top edges.
class Lines {
 public:
  Lines(const Rgba8Image& image, const EdgePlane& edges, WeightPlane& weights, bool is_horizontal)
      : image_(image), edges_(edges), weights_(weights), is_horizontal_(is_horizontal) {}

  /// Computes the weights of the horizontal lines above row y, which are searched eight pixels at a time.
  void weigh_row(int y) {
    const std::uint8_t* row = edges_.at(0, y);
    for (int x = 0; x < length();) {
      const std::uint64_t eight = edges_of_eight(row + x, top_edge);
      x += std::countr_zero(eight) / 8;
      if (eight == 0 || x >= length()) continue;
      const int begin = x;
      for (std::uint64_t gaps = 0; gaps == 0 && x < length();) {
        gaps = edges_of_eight(row + x, top_edge) ^ top_edge * ones;
        x += std::countr_zero(gaps) / 8;
      }
      weigh_line(begin, std::min(x, length()), y);
    }
  }

  /// Computes the weights of the vertical lines on the left of `strip` columns starting at `first`, row by row: a
  /// single column would load a cache line for every pixel.
  void weigh_strip(int first) {
    std::array<int, strip> begin;
    std::uint64_t open = 0;
    const auto end_lines = [&](std::uint64_t which, int y) {
      for (; which != 0; which &= which - 1) {
        const int column = std::countr_zero(which);
        weigh_line(begin[static_cast<std::size_t>(column)], y, first + column);
      }
    };
    const int columns = std::min(strip, image_.width() - first);
    const std::uint64_t inside = columns < strip ? (std::uint64_t{1} << columns) - 1 : ~std::uint64_t{0};
    for (int y = 0; y < length(); ++y) {
      std::uint64_t here = 0;
      for (int x = 0; x < columns; x += 8) here |= bits_of_eight(edges_.at(first + x, y)) << x;
      here &= inside;
      end_lines(open & ~here, y);
      for (std::uint64_t which = here & ~open; which != 0; which &= which - 1)
        begin[static_cast<std::size_t>(std::countr_zero(which))] = y;
      open = here;
    }
    end_lines(open, length());
  }

  static constexpr int strip = 64;

 private:
  int count() const { return is_horizontal_ ? image_.height() : image_.width(); }
  int length() const { return is_horizontal_ ? image_.width() : image_.height(); }
  const std::uint8_t& edge(int i, int j) const { return *(is_horizontal_ ? edges_.at(i, j) : edges_.at(j, i)); }
  /// Whether an edge crosses the line before pixel i of row j; false at the image's sides.
  bool crosses(int i, int j) const {
    return i > 0 && i < length() && edge(i, j) & (is_horizontal_ ? left_edge : top_edge);
  }
  /// The sum of a pixel's encoded values, weighted as luma.
  int luma(int i, int j) const {
    const int jj = std::clamp(j, 0, count() - 1);
    const Rgba8 c = is_horizontal_ ? image_(i, jj) : image_(jj, i);
    return 299 * c.r + 587 * c.g + 114 * c.b;
  }

  void weigh_line(int begin, int end, int j) {
    const bool below[2] = {crosses(begin, j), crosses(end, j)}, above[2] = {crosses(begin, j - 1), crosses(end, j - 1)};
    Side side[2];
    for (int k = 0; k < 2; ++k) side[k] = below[k] == above[k] ? Side::None : below[k] ? Side::Below : Side::Above;
    // If edges cross on both sides of an end, the side is chosen that makes a Z shape with the other end.
    for (int k = 0; k < 2; ++k)
      if (below[k] && above[k] && side[1 - k] != Side::None)
        side[k] = below[1 - k] && above[1 - k] ? Side::None : side[1 - k] == Side::Below ? Side::Above : Side::Below;
    const bool is_whole = side[0] == Side::None || side[1] == Side::None;
    const float reach = static_cast<float>(end - begin) / (is_whole ? 1.0f : 2.0f);
    if (side[0] != Side::None) weigh_part(begin, 1, reach, j, side[0]);
    if (side[1] != Side::None) weigh_part(end - 1, -1, reach, j, side[1]);
  }

  /// Adds the triangle that begins at the step before pixel `first` and ends after `reach` pixels.
  void weigh_part(int first, int direction, float reach, int j, Side side) {
    const int near = side == Side::Below ? j : j - 1, across = side == Side::Below ? j - 1 : j;
    const int beyond = first - direction;
    const float height =
        split_height(luma(first, near), luma(first, across), luma(beyond, near), luma(beyond, near + (near - across)));
    float at = height * reach / reach;
    for (int k = 0; static_cast<float>(k) < reach; ++k) {
      const float rest = std::min(1.0f, reach - static_cast<float>(k));
      const float next = height * (reach - static_cast<float>(k) - rest) / reach;
      add(first + direction * k, j, side, (at + next) * 0.5f * rest);
      at = next;
    }
  }

  void add(int i, int j, Side side, float area) {
    EdgeWeights& w = *(is_horizontal_ ? weights_.at(i, j) : weights_.at(j, i));
    std::uint8_t& weight = is_horizontal_ ? (side == Side::Below ? w.from_above : w.to_above)
                                          : (side == Side::Below ? w.from_left : w.to_left);
    weight = static_cast<std::uint8_t>(std::min(255, weight + round_unorm8(255 * area)));
  }

  const Rgba8Image& image_;
  const EdgePlane& edges_;
  WeightPlane& weights_;
  bool is_horizontal_;
};

}  // namespace

WeightPlane mlaa_reshetov_weights(const Rgba8Image& image) {
  const EdgePlane edges = find_edges(image);
  WeightPlane weights(image.width(), image.height(), 1);
  for_rows(image.height(), [&](int y) {
    std::memset(static_cast<void*>(weights.at(0, y)), 0, sizeof(EdgeWeights) * static_cast<std::size_t>(image.width()));
  });
  Lines level(image, edges, weights, true), upright(image, edges, weights, false);
  for_rows(image.height(), [&](int y) { level.weigh_row(y); });
  constexpr int strip = Lines::strip;
  parallel_for(static_cast<std::size_t>((image.width() + strip - 1) / strip),
               [&](std::size_t i) { upright.weigh_strip(strip * static_cast<int>(i)); });
  weights.extend();
  return weights;
}

}  // namespace antialias
}  // namespace zoneplate
