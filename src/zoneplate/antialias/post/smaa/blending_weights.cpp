// SPDX-License-Identifier: Apache-2.0
// SMAA's second pass, blending weight calculation: for each edge, the distances to its ends and the edges that cross
// there determine the areas of its pixels, which are read from the area tables.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/exact_weights.h"
#include "zoneplate/antialias/post/smaa/searches.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/post/smaa/tables.h"

namespace zoneplate::antialias {
namespace {

/// The square root of a distance as a position in the area table: a cell and the fraction of the next one.
struct Root {
  int cell = 0;
  float share = 0;
};

}  // namespace

/// The data that is common to all pixels.
struct SmaaTables : SmaaSearches {
  const AreaSlot* slots[4] = {};  ///< null for areas in closed form
  std::array<Root, 256> roots;
  float corner_strength;  ///< the fraction of an area that a corner removes

  explicit SmaaTables(const SmaaOptions& o) {
    const AreaRounding rounding = o.is_postprocessing ? AreaRounding::Nearest : AreaRounding::Down;
    for (std::size_t i = 0; i < 4 && !o.exact_offset; ++i) slots[i] = &area_slot(o.slots[i], rounding);
    for (std::size_t d = 0; d < roots.size(); ++d) {
      const float root = std::sqrt(static_cast<float>(d)), cell = std::floor(root);
      roots[d] = {static_cast<int>(cell), root - cell};
    }
    corner_strength = 1 - static_cast<float>(o.corner_rounding) / 100;
  }
};

namespace {

[[gnu::always_inline]] inline Areas fetch(const AreaSlot& slot, int x, float u, int y, float v) {
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

template <std::uint8_t own>
[[gnu::always_inline]] inline Areas line_areas(const EdgeLine<own>& line, const SearchSteps& steps,
                                               const SmaaTables& tables, const AreaSlot& slot,
                                               const SmaaOptions& options) {
  const LineEnds ends = line.ends(steps, options.steps);
  const Root l = tables.roots[static_cast<std::size_t>(std::abs(ends.before))];
  const Root r = tables.roots[static_cast<std::size_t>(std::abs(ends.after))];
  // Without crossing edges there is no area, except that at the longest distances the fetch interpolates with the next
  // pattern.
  if (ends.left_code + ends.right_code == 0 && std::max(l.cell, r.cell) < 15) return {};
  Areas areas = fetch(slot, 16 * ends.left_code + l.cell, l.share, 16 * ends.right_code + r.cell, r.share);
  if (options.corner_rounding < 100) {
    const Areas factors = line.corner_factors(ends, tables.corner_strength, options.is_postprocessing);
    areas.from *= factors.from, areas.to *= factors.to;
  }
  return areas;
}

[[gnu::always_inline]] inline Areas diagonal_areas(const Diagonals& diagonals, const SmaaTables& tables) {
  const auto fetch_diagonal = [](const AreaSlot& slot, const DiagonalEnds& ends) {
    const int x = 20 * ends.left_code + ends.left, y = 20 * ends.right_code + ends.right;
    const std::size_t at = static_cast<std::size_t>(2 * (y * AreaSlot::size + x));
    return Areas{unorm8_value[slot.diagonal[at]], unorm8_value[slot.diagonal[at + 1]]};
  };
  Areas rising, falling;
  if (const auto ends = diagonals.rising()) rising = fetch_diagonal(*tables.slots[2], *ends);
  if (const auto ends = diagonals.falling()) {
    const Areas found = fetch_diagonal(*tables.slots[3], *ends);
    falling = {found.to, found.from};
  }
  return {rising.from + falling.from, rising.to + falling.to};
}

std::uint8_t weight_of(float area) { return round_unorm8(std::min(area, 1.0f) * 255); }

[[gnu::always_inline]] inline EdgeWeights weights_of(const std::uint8_t* pixel, std::ptrdiff_t stride,
                                                     const SmaaTables& tables, const SmaaOptions& options) {
  EdgeWeights w;
  if (*pixel & top_edge) {
    Areas areas;
    if (options.diagonal_steps > 0) areas = diagonal_areas(Diagonals(pixel, stride, options.diagonal_steps), tables);
    const bool is_diagonal = areas.from + areas.to > 0;
    if (!is_diagonal)
      areas = line_areas(EdgeLine<top_edge>(pixel, stride), tables.along_top, tables, *tables.slots[1], options);
    w.from_above = weight_of(areas.from), w.to_above = weight_of(areas.to);
    if (is_diagonal) return w;
  }
  if (*pixel & left_edge) {
    const Areas areas =
        line_areas(EdgeLine<left_edge>(pixel, stride), tables.along_left, tables, *tables.slots[0], options);
    w.from_left = weight_of(areas.from), w.to_left = weight_of(areas.to);
  }
  return w;
}

}  // namespace

SmaaBlendingWeights::SmaaBlendingWeights(const EdgePlane& edges, const SmaaOptions& options)
    : edges_(edges), options_(options), tables_(std::make_unique<SmaaTables>(options)) {}
SmaaBlendingWeights::~SmaaBlendingWeights() = default;

void SmaaBlendingWeights::find(int y, WeightRow& out) const {
  if (options_.exact_offset) return compute_exact_weights(edges_, y, *tables_, options_, out);
  const std::uint8_t* row = edges_.at(0, y);
  for_edges(edges_, y, [&](int x) { out.set(x, weights_of(row + x, edges_.stride(), *tables_, options_)); });
}

int smaa_radius(const SmaaOptions& options) {
  // The search, the pixel across its end, the edges that cross two pixels away, and the neighbourhood of edge
  // detection.
  return std::max(2 * options.steps + 1, options.diagonal_steps + 1) + 4;
}

}  // namespace zoneplate::antialias
