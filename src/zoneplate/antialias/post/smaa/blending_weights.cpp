// SPDX-License-Identifier: Apache-2.0
// SMAA's second pass, blending weight calculation: for each edge, the distances to its ends and the edges that cross
// there determine the areas of its pixels.
//
// The shaders fetch between four or two pixels and decode the result; this implementation reads the pixels' bits. Left
// edges are top edges with x and y exchanged, so that the same code processes both.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/post/smaa/tables.h"

namespace zoneplate::antialias {
namespace {

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

/// The square root of a distance as a position in the area table: a cell and the fraction of the next one.
struct Root {
  int cell = 0;
  float share = 0;
};

}  // namespace

/// The data that is common to all pixels.
struct SmaaTables {
  const AreaSlot* slots[4];
  SearchSteps along_top{top_edge, left_edge}, along_left{left_edge, top_edge};
  std::array<Root, 256> roots;
  float corner_strength;  ///< the fraction of an area that a corner removes

  explicit SmaaTables(const SmaaOptions& o) {
    const AreaRounding rounding = o.is_postprocessing ? AreaRounding::Nearest : AreaRounding::Down;
    for (std::size_t i = 0; i < 4; ++i) slots[i] = &area_slot(o.slots[i], rounding);
    for (std::size_t d = 0; d < roots.size(); ++d) {
      const float root = std::sqrt(static_cast<float>(d)), cell = std::floor(root);
      roots[d] = {static_cast<int>(cell), root - cell};
    }
    corner_strength = 1 - static_cast<float>(o.corner_rounding) / 100;
  }
};

namespace {

/// Two areas in [0, 1]: the weight of the pixel across the border in this one, and of this one in the other.
struct Areas {
  float from = 0, to = 0;
};

/// The edges relative to one pixel, along or across a line that is horizontal (top edges) or vertical (left edges).
template <std::uint8_t own>
class Line {
 public:
  Line(const std::uint8_t* pixel, std::ptrdiff_t stride)
      : pixel_(pixel), along_(is_top ? 1 : stride), across_(is_top ? stride : 1) {}

  Areas areas(const SmaaTables& tables, const AreaSlot& slot, const SmaaOptions& options) const {
    const SearchSteps& steps = is_top ? tables.along_top : tables.along_left;
    const int before = start(steps, options.steps), after = end(steps, options.steps);
    const int left_code = 3 * crosses(before, 0) + crosses(before, -1);
    const int right_code = 3 * crosses(after + 1, 0) + crosses(after + 1, -1);
    const Root l = tables.roots[static_cast<std::size_t>(std::abs(before))];
    const Root r = tables.roots[static_cast<std::size_t>(std::abs(after))];
    // Without crossing edges there is no area, except that at the longest distances the fetch interpolates with the
    // next pattern.
    if (left_code + right_code == 0 && std::max(l.cell, r.cell) < 15) return {};
    Areas areas = fetch(slot, 16 * left_code + l.cell, l.share, 16 * right_code + r.cell, r.share);
    if (options.corner_rounding < 100) round_corners(before, after, tables.corner_strength, options, areas);
    return areas;
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

  static Areas fetch(const AreaSlot& slot, int x, float u, int y, float v) {
    const int right = std::min(x + 1, AreaSlot::size - 1), lower = std::min(y + 1, AreaSlot::size - 1);
    const auto at = [&](int column, int row, int c) {
      return unorm8_value[slot.orthogonal[static_cast<std::size_t>(2 * (row * AreaSlot::size + column) + c)]];
    };
    const auto mixed = [&](int c) {
      const float above = at(x, y, c) + (at(right, y, c) - at(x, y, c)) * u;
      const float below = at(x, lower, c) + (at(right, lower, c) - at(x, lower, c)) * u;
      return above + (below - above) * v;
    };
    return {mixed(0), mixed(1)};
  }

  /// If the edge that crosses an end continues one pixel farther across the line, the corner is sharp: the area is
  /// reduced.
  void round_corners(int before, int after, float strength, const SmaaOptions& options, Areas& areas) const {
    const int l = options.is_postprocessing ? before : -before, r = after;
    const bool is_left = l <= r, is_right = r <= l;
    const float share = strength / static_cast<float>(is_left + is_right);
    const auto factor = [&](int j) {
      float f = 1;
      if (is_left) f -= share * static_cast<float>(crosses(before, j));
      if (is_right) f -= share * static_cast<float>(crosses(after + 1, j));
      return std::clamp(f, 0.0f, 1.0f);
    };
    areas.from *= factor(1);
    areas.to *= factor(-2);
  }

  const std::uint8_t* pixel_;
  std::ptrdiff_t along_, across_;
};

/// The diagonals through a pixel's top edge.
class Diagonals {
 public:
  Diagonals(const std::uint8_t* pixel, std::ptrdiff_t stride, int steps)
      : pixel_(pixel), stride_(stride), steps_(steps) {}

  Areas areas(const SmaaTables& tables) const {
    Areas rising, falling;
    if (may_rise()) rising = rising_areas(*tables.slots[2]);
    if (may_fall()) falling = falling_areas(*tables.slots[3]);
    return {rising.from + falling.from, rising.to + falling.to};
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

  static Areas fetch(const AreaSlot& slot, const Found& a, const Found& b, int code_a, int code_b) {
    const int x = 20 * (a.goes_on ? 0 : code_a) + a.distance, y = 20 * (b.goes_on ? 0 : code_b) + b.distance;
    const std::size_t at = static_cast<std::size_t>(2 * (y * AreaSlot::size + x));
    return {unorm8_value[slot.diagonal[at]], unorm8_value[slot.diagonal[at + 1]]};
  }

  Areas rising_areas(const AreaSlot& slot) const {
    Found a;
    if (left(0, 0)) {
      a = search(-1, 1, 0);
      a.distance += a.is_top;
    }
    const Found b = search(1, -1, 0);
    if (a.distance + b.distance <= 2) return {};
    const int p = a.distance, q = b.distance;
    return fetch(slot, a, b, 2 * top(-p - 1, p) + left(-p, p), 2 * top(q + 1, -q) + left(q + 1, -q - 1));
  }

  Areas falling_areas(const AreaSlot& slot) const {
    const Found a = search(-1, -1, 1);
    Found b;
    if (left(1, 0)) {
      b = search(1, 1, 1);
      b.distance += b.is_top;
    }
    if (a.distance + b.distance <= 2) return {};
    const int p = a.distance, q = b.distance;
    const Areas found = fetch(slot, a, b, 2 * top(-p - 1, -p) + left(-p, -p - 1), 2 * top(q + 1, q) + left(q + 1, q));
    return {found.to, found.from};
  }

  const std::uint8_t* pixel_;
  std::ptrdiff_t stride_;
  int steps_;
};

std::uint8_t weight_of(float area) { return round_unorm8(std::min(area, 1.0f) * 255); }

EdgeWeights weights_of(const std::uint8_t* pixel, std::ptrdiff_t stride, const SmaaTables& tables,
                       const SmaaOptions& options) {
  EdgeWeights w;
  if (*pixel & top_edge) {
    Areas areas;
    if (options.diagonal_steps > 0) areas = Diagonals(pixel, stride, options.diagonal_steps).areas(tables);
    const bool is_diagonal = areas.from + areas.to > 0;
    if (!is_diagonal) areas = Line<top_edge>(pixel, stride).areas(tables, *tables.slots[1], options);
    w.from_above = weight_of(areas.from), w.to_above = weight_of(areas.to);
    if (is_diagonal) return w;
  }
  if (*pixel & left_edge) {
    const Areas areas = Line<left_edge>(pixel, stride).areas(tables, *tables.slots[0], options);
    w.from_left = weight_of(areas.from), w.to_left = weight_of(areas.to);
  }
  return w;
}

}  // namespace

SmaaBlendingWeights::SmaaBlendingWeights(const EdgePlane& edges, const SmaaOptions& options)
    : edges_(edges), options_(options), tables_(std::make_unique<SmaaTables>(options)) {}
SmaaBlendingWeights::~SmaaBlendingWeights() = default;

void SmaaBlendingWeights::find(int y, WeightRow& out) const {
  const std::uint8_t* row = edges_.at(0, y);
  for (int block = 0; block < edges_.width(); block += 8) {
    std::uint64_t any = 0;
    std::memcpy(&any, row + block, sizeof any);
    for (any = (any | any >> 1) & 0x0101010101010101; any != 0; any &= any - 1) {
      const int x = block + std::countr_zero(any) / 8;
      if (x < edges_.width()) out.set(x, weights_of(row + x, edges_.stride(), *tables_, options_));
    }
  }
}

int smaa_reach(const SmaaOptions& options) {
  // The search, the pixel across its end, the edges that cross two pixels away, and the neighbourhood of edge
  // detection.
  return std::max(2 * options.steps + 1, options.diagonal_steps + 1) + 4;
}

}  // namespace zoneplate::antialias
