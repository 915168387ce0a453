// SMAA's second pass: how far each edge goes and what crosses its ends, and with that the areas of its pixels.
//
// The shaders fetch between four or two pixels and decode what they find; here the pixels' bits are read themselves.
// Left edges are top edges with x and y exchanged, so that one walk serves both.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/antialias/smaa.h"
#include "zoneplate/antialias/smaa_tables.h"

namespace zoneplate::antialias {
namespace {

/// By the bits of four pixels (0: across and beyond, 1: across, 2: beyond, 3: here), of the edges that cross (high) and
/// of those along (low): how many of the last two pixels belong to the line.
struct SearchLengths {
  std::array<std::uint8_t, 256> before{}, after{};
  SearchLengths() {
    const std::vector<std::uint8_t> table = make_search_table();
    const auto value = [](std::size_t bits) {
      return (bits & 1) + 3 * (bits >> 1 & 1) + 7 * (bits >> 2 & 1) + 21 * (bits >> 3 & 1);
    };
    for (std::size_t i = 0; i < 256; ++i) {
      const std::size_t cross = value(i >> 4), y = std::min<std::size_t>(15, 32 - value(i & 15));
      before[i] = table[64 * y + cross] / 127;
      after[i] = table[64 * y + std::min<std::size_t>(63, cross + 33)] / 127;
    }
  }
};

/// A distance as a place in the areas: whole cells and the share of the next one.
struct Root {
  int cell = 0;
  float share = 0;
};

}  // namespace

/// What all pixels share.
struct SmaaTables {
  const AreaSlot* slots[4];
  SearchLengths lengths;
  std::array<Root, 256> roots;
  float corner_strength;  ///< how much of an area a corner takes

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

/// Two areas in [0, 1]: this pixel's share of the one across its border, and the other's share of this one.
struct Areas {
  float from = 0, to = 0;
};

/// The edges seen from one pixel, along or across a line that is horizontal (top edges) or vertical (left edges).
class Line {
 public:
  Line(const std::uint8_t* pixel, std::ptrdiff_t along, std::ptrdiff_t across, std::uint8_t own, std::uint8_t cross)
      : pixel_(pixel), along_(along), across_(across), own_(own), cross_(cross) {}

  Areas areas(const SmaaTables& tables, const AreaSlot& slot, const SmaaOptions& options) const {
    const int before = start(tables, options.steps), after = end(tables, options.steps);
    const Root l = tables.roots[static_cast<std::size_t>(std::abs(before))];
    const Root r = tables.roots[static_cast<std::size_t>(std::abs(after))];
    const int left_code = 3 * crosses(before, 0) + crosses(before, -1);
    const int right_code = 3 * crosses(after + 1, 0) + crosses(after + 1, -1);
    // Where nothing crosses there is no area, but for what the fetch at the longest distances takes of the next
    // pattern.
    if (left_code + right_code == 0 && std::max(l.cell, r.cell) < 15) return {};
    Areas areas = fetch(slot, 16 * left_code + l.cell, l.share, 16 * right_code + r.cell, r.share);
    if (options.corner_rounding < 100) round_corners(before, after, tables.corner_strength, options, areas);
    return areas;
  }

 private:
  bool is(int i, int j, std::uint8_t edge) const { return pixel_[i * along_ + j * across_] & edge; }
  int crosses(int i, int j) const { return is(i, j, cross_) ? 1 : 0; }

  /// The four pixels between which a search fetches: i and the one beyond it, here and across.
  struct Four {
    int here, beyond, here_across, beyond_across;
  };
  Four four(int i, int beyond) const {
    const std::uint8_t *p = pixel_ + i * along_, *q = pixel_ + beyond * along_;
    return {*p, *q, *(p - across_), *(q - across_)};
  }
  /// Both pixels of the line are edges, and nothing crosses.
  bool goes_on(const Four& f) const {
    return (f.here & f.beyond & own_) != 0 && ((f.here | f.beyond | f.here_across | f.beyond_across) & cross_) == 0;
  }
  /// The bits of SearchLengths.
  std::size_t bits_of(const Four& f) const {
    const auto bits = [&](int edge) {
      const auto is = [edge](int pixel) { return (pixel & edge) != 0; };
      return is(f.beyond_across) | is(f.here_across) << 1 | is(f.beyond) << 2 | is(f.here) << 3;
    };
    return static_cast<std::size_t>(bits(own_) | bits(cross_) << 4);
  }

  /// The first and the last pixel of the line, as distances; looked for two pixels at a time.
  int start(const SmaaTables& tables, int steps) const {
    int k = 0;
    Four found;
    do found = four(-2 * k, -2 * k - 1);
    while (++k < steps && goes_on(found));
    return 3 - 2 * k - tables.lengths.before[bits_of(found)];
  }
  int end(const SmaaTables& tables, int steps) const {
    int k = 0;
    Four found;
    do found = four(2 * k + 1, 2 * k + 2);
    while (++k < steps && goes_on(found));
    return 2 * k - 2 + tables.lengths.after[bits_of(found)];
  }

  static Areas fetch(const AreaSlot& slot, int x, float u, int y, float v) {
    const int right = std::min(x + 1, AreaSlot::size - 1), lower = std::min(y + 1, AreaSlot::size - 1);
    const auto at = [&](int column, int row, int c) {
      return code_share[slot.orthogonal[static_cast<std::size_t>(2 * (row * AreaSlot::size + column) + c)]];
    };
    const auto mixed = [&](int c) {
      const float above = at(x, y, c) + (at(right, y, c) - at(x, y, c)) * u;
      const float below = at(x, lower, c) + (at(right, lower, c) - at(x, lower, c)) * u;
      return above + (below - above) * v;
    };
    return {mixed(0), mixed(1)};
  }

  /// Where an edge crosses a little farther away, the line is the side of a sharp corner: less of it is taken.
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
  std::uint8_t own_, cross_;
};

/// The diagonals through a pixel's top edge.
class Diagonals {
 public:
  Diagonals(const std::uint8_t* pixel, std::ptrdiff_t stride, int steps)
      : pixel_(pixel), stride_(stride), steps_(steps) {}

  Areas areas(const SmaaTables& tables) const {
    const Areas rising = rising_areas(*tables.slots[2]), falling = falling_areas(*tables.slots[3]);
    return {rising.from + falling.from, rising.to + falling.to};
  }

 private:
  struct Found {
    int distance = 0;
    bool goes_on = false;  ///< the search ended on an edge
    bool is_top = false;   ///< of the last pixel
  };
  int left(int x, int y) const { return pixel_[y * stride_ + x] & left_edge ? 1 : 0; }
  int top(int x, int y) const { return pixel_[y * stride_ + x] & top_edge ? 1 : 0; }

  /// Follows a diagonal as long as pixels have both edges; the left one is that of the pixel `shift` to the right.
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
    return {code_share[slot.diagonal[at]], code_share[slot.diagonal[at + 1]]};
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

std::uint8_t weight_of(float area) { return rounded_code(std::min(area, 1.0f) * 255); }

EdgeWeights weights_of(const std::uint8_t* pixel, std::ptrdiff_t stride, const SmaaTables& tables,
                       const SmaaOptions& options) {
  EdgeWeights w;
  if (*pixel & top_edge) {
    Areas areas;
    if (options.diagonal_steps > 0) areas = Diagonals(pixel, stride, options.diagonal_steps).areas(tables);
    const bool is_diagonal = areas.from + areas.to > 0;
    if (!is_diagonal) areas = Line(pixel, 1, stride, top_edge, left_edge).areas(tables, *tables.slots[1], options);
    w.from_above = weight_of(areas.from), w.to_above = weight_of(areas.to);
    if (is_diagonal) return w;
  }
  if (*pixel & left_edge) {
    const Areas areas = Line(pixel, stride, 1, left_edge, top_edge).areas(tables, *tables.slots[0], options);
    w.from_left = weight_of(areas.from), w.to_left = weight_of(areas.to);
  }
  return w;
}

}  // namespace

SmaaWeigher::SmaaWeigher(const EdgePlane& edges, const SmaaOptions& options)
    : edges_(edges), options_(options), tables_(std::make_unique<SmaaTables>(options)) {}
SmaaWeigher::~SmaaWeigher() = default;

void SmaaWeigher::weigh(int y, WeightRow& out) const {
  for (int block = 0; block < edges_.width(); block += 8) {
    std::uint64_t any = 0;
    std::memcpy(&any, edges_.at(block, y), sizeof any);
    if (any == 0) continue;
    for (int x = block; x < std::min(block + 8, edges_.width()); ++x)
      if (*edges_.at(x, y) != 0) out.put(x, weights_of(edges_.at(x, y), edges_.stride(), *tables_, options_));
  }
}

int smaa_reach(const SmaaOptions& options) {
  // The search, the pixel across its end, what crosses two pixels away, and the edges' own look at their surroundings.
  return std::max(2 * options.steps + 1, options.diagonal_steps + 1) + 4;
}

}  // namespace zoneplate::antialias
