// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "zoneplate/antialias/post/edge_rows.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/post/smaa/tables.h"

/// The searches of SMAA's second pass: from an edge to the ends of its line or of its diagonal.
///
/// The shaders fetch between four or two pixels and decode the result; this implementation reads the pixels' bits. Left
/// edges are top edges with x and y exchanged, so that the same code processes both.
namespace zoneplate::antialias {

/// The decoded result of a search fetch between four pixels. The index has the edges, two bits each, of the nearer and
/// the farther pixel of the line and of the two across from them.
struct SearchSteps {
  static constexpr std::uint8_t length = 3;   ///< the number of the two pixels that belong to the line
  static constexpr std::uint8_t goes_on = 4;  ///< both pixels do, and no edge crosses
  std::array<std::uint8_t, 256> before{}, after{};

  SearchSteps(std::uint8_t own, std::uint8_t cross) {
    const std::vector<std::uint8_t> table = make_search_table();
    for (std::size_t four = 0; four < 256; ++four) {
      const auto weighed = [&](std::uint8_t edge) {
        const auto is = [&](int pixel) { return four >> 2 * pixel & edge ? std::size_t{1} : std::size_t{0}; };
        return 21 * is(0) + 7 * is(1) + 3 * is(2) + is(3);
      };
      const std::size_t x = weighed(cross), y = std::min<std::size_t>(15, 32 - weighed(own));
      const bool is_line = (four & four >> 2 & own) != 0 && x == 0;
      const auto step = [&](std::size_t column) {
        return static_cast<std::uint8_t>(table[64 * y + column] / 127 | (is_line ? goes_on : 0));
      };
      before[four] = step(x), after[four] = step(std::min<std::size_t>(63, x + 33));
    }
  }
};

/// Two areas in [0, 1]: the weight of the pixel across the border in this one, and of this one in the other.
struct Areas {
  float from = 0, to = 0;
};

/// The ends of the line of an edge: the positions of its first and last pixel relative to one of them, and the edges
/// that cross there, by SMAA's codes: 1 across the border, 3 on the pixel's own side, 4 both.
struct LineEnds {
  int before, after;
  int left_code, right_code;
};

/// The edges relative to one pixel, along or across a line that is horizontal (top edges) or vertical (left edges).
template <std::uint8_t own>
class EdgeLine {
 public:
  EdgeLine(const std::uint8_t* pixel, std::ptrdiff_t stride)
      : pixel_(pixel), along_(is_top ? 1 : stride), across_(is_top ? stride : 1) {}

  [[gnu::always_inline]] LineEnds ends(const SearchSteps& steps, int most) const {
    const int before = start(steps, most), after = end(steps, most);
    return {before, after, 3 * crosses(before, 0) + crosses(before, -1),
            3 * crosses(after + 1, 0) + crosses(after + 1, -1)};
  }

  /// Whether an edge that crosses an end, on the side of the border with index j, continues one pixel farther.
  bool has_corner(const LineEnds& ends, int side) const {
    const int j = side > 0 ? -2 : 1;
    return crosses(ends.before, j) | crosses(ends.after + 1, j);
  }

  /// The factors of both areas. If the edge that crosses an end continues one pixel farther across the line, the corner
  /// is sharp: the area is reduced.
  [[gnu::always_inline]] Areas corner_factors(const LineEnds& ends, float strength, bool is_postprocessing) const {
    const int l = is_postprocessing ? ends.before : -ends.before, r = ends.after;
    const bool is_left = l <= r, is_right = r <= l;
    const float share = strength / static_cast<float>(is_left + is_right);
    const auto factor = [&](int j) {
      float f = 1;
      if (is_left) f -= share * static_cast<float>(crosses(ends.before, j));
      if (is_right) f -= share * static_cast<float>(crosses(ends.after + 1, j));
      return std::clamp(f, 0.0f, 1.0f);
    };
    return {factor(1), factor(-2)};
  }

 private:
  static constexpr bool is_top = own == top_edge;
  static constexpr std::uint8_t cross = is_top ? left_edge : top_edge;

  int crosses(int i, int j) const { return pixel_[i * along_ + j * across_] & cross ? 1 : 0; }

  /// The index in SearchSteps of the edges of pixel i of the line and of pixel `beyond`.
  std::size_t four(int i, int beyond) const {
    const std::uint8_t *p = pixel_ + i * along_, *q = pixel_ + beyond * along_;
    return static_cast<std::size_t>(p[0] | q[0] << 2 | *(p - across_) << 4 | *(q - across_) << 6);
  }

  /// The number of consecutive pairs of pixels from `first` in one direction that continue the line without crossing
  /// edges; at most `limit`. The pixels of a horizontal line are adjacent in memory and are tested eight at a time.
  int pairs_on(const SearchSteps& steps, int first, int direction, int limit) const {
    if constexpr (!is_top) {
      int k = 0;
      const auto at = [&](int i) { return first + direction * (2 * k + i); };
      while (k < limit && steps.before[four(at(0), at(1))] & SearchSteps::goes_on) ++k;
      return k;
    }
    constexpr std::uint64_t ones = 0x0101010101010101;
    for (int i = 0; i < 2 * limit; i += 8) {
      const std::uint8_t* p = pixel_ + (direction > 0 ? first + i : first - i - 7);
      std::uint64_t here, above;
      std::memcpy(&here, p, sizeof here), std::memcpy(&above, p - across_, sizeof above);
      const std::uint64_t ends = ones & ~(here >> 1 & ~(here | above));
      if (ends == 0) continue;
      const int good = (direction > 0 ? std::countr_zero(ends) : std::countl_zero(ends)) / 8;
      return std::min(limit, (i + good) / 2);
    }
    return limit;
  }

  /// The distances of the first and of the last pixel of the line; the search steps by two pixels, at most `most`
  /// times.
  int start(const SearchSteps& steps, int most) const {
    const int k = pairs_on(steps, 0, -1, most - 1);
    return 1 - 2 * k - (steps.before[four(-2 * k, -2 * k - 1)] & SearchSteps::length);
  }
  int end(const SearchSteps& steps, int most) const {
    const int k = pairs_on(steps, 1, 1, most - 1);
    return 2 * k + (steps.after[four(2 * k + 1, 2 * k + 2)] & SearchSteps::length);
  }

  const std::uint8_t* pixel_;
  std::ptrdiff_t along_, across_;
};

/// The ends of a diagonal: the distances to its first and last pixel, and the edges that cross there, by SMAA's codes:
/// 1 the left edge, 2 the top one, 3 both; 0 where the search ended on the diagonal.
struct DiagonalEnds {
  int left, right;
  int left_code, right_code;
};

/// The diagonals through a pixel's top edge.
class Diagonals {
 public:
  Diagonals(const std::uint8_t* pixel, std::ptrdiff_t stride, int steps)
      : pixel_(pixel), stride_(stride), steps_(steps) {}

  /// The diagonal that rises to the right, if it is long enough.
  [[gnu::always_inline]] std::optional<DiagonalEnds> rising() const {
    if (!may_rise()) return std::nullopt;
    Found a;
    if (left(0, 0)) {
      a = search(-1, 1, 0);
      a.distance += a.is_top;
    }
    const Found b = search(1, -1, 0);
    if (a.distance + b.distance <= 2) return std::nullopt;
    const int p = a.distance, q = b.distance;
    return ends_of(a, b, 2 * top(-p - 1, p) + left(-p, p), 2 * top(q + 1, -q) + left(q + 1, -q - 1));
  }
  /// The diagonal that falls to the right; its two areas are exchanged.
  [[gnu::always_inline]] std::optional<DiagonalEnds> falling() const {
    if (!may_fall()) return std::nullopt;
    const Found a = search(-1, -1, 1);
    Found b;
    if (left(1, 0)) {
      b = search(1, 1, 1);
      b.distance += b.is_top;
    }
    if (a.distance + b.distance <= 2) return std::nullopt;
    const int p = a.distance, q = b.distance;
    return ends_of(a, b, 2 * top(-p - 1, -p) + left(-p, -p - 1), 2 * top(q + 1, q) + left(q + 1, q));
  }

 private:
  struct Found {
    int distance = 0;
    bool goes_on = false;  ///< the search ended on an edge
    bool is_top = false;   ///< whether the last pixel has a top edge
  };
  int left(int x, int y) const { return pixel_[y * stride_ + x] & left_edge ? 1 : 0; }
  int top(int x, int y) const { return pixel_[y * stride_ + x] & top_edge ? 1 : 0; }

  /// False if both searches end at their first pixel, so that the diagonal is too short.
  bool may_rise() const { return (top(1, -1) && left(1, -1)) || (left(0, 0) && top(-1, 1) && left(-1, 1)); }
  bool may_fall() const { return (top(-1, -1) && left(0, -1)) || (left(1, 0) && top(1, 1) && left(2, 1)); }

  /// Follows a diagonal while pixels have both edges; the left edge is that of the pixel `shift` to the right.
  Found search(int dx, int dy, int shift) const {
    Found f{-1, true, false};
    for (int x = 0, y = 0; f.distance < steps_ - 1 && f.goes_on;) {
      x += dx, y += dy, ++f.distance;
      f.is_top = top(x, y);
      f.goes_on = f.is_top && left(x + shift, y);
    }
    return f;
  }

  static DiagonalEnds ends_of(const Found& a, const Found& b, int code_a, int code_b) {
    return {a.distance, b.distance, a.goes_on ? 0 : code_a, b.goes_on ? 0 : code_b};
  }

  const std::uint8_t* pixel_;
  std::ptrdiff_t stride_;
  int steps_;
};

/// Calls body(x) for each pixel of a row that has an edge.
template <class Body>
void for_edges(const EdgePlane& edges, int y, const Body& body) {
  const std::uint8_t* row = edges.at(0, y);
  for (int block = 0; block < edges.width(); block += 8) {
    std::uint64_t any = 0;
    std::memcpy(&any, row + block, sizeof any);
    for (any = (any | any >> 1) & 0x0101010101010101; any != 0; any &= any - 1) {
      const int x = block + std::countr_zero(any) / 8;
      if (x < edges.width()) body(x);
    }
  }
}

}  // namespace zoneplate::antialias
