// SPDX-License-Identifier: Apache-2.0
// SMAA's second pass with areas in closed form: the ends of the edges of some pixels are collected, so that the areas
// of all of them are computed together.
#include "zoneplate/antialias/post/smaa/exact_weights.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/exact_areas.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t capacity = 32;  ///< pixels that are collected

/// Pixels at axis-parallel edges.
struct Lines {
  std::size_t count = 0;
  std::array<std::size_t, capacity> pixel;
  std::array<Areas, capacity> factors;
  std::array<float, capacity> from, to, left, right, is_corner;

  template <class Of>
  void add(std::size_t at, const Of& line, const LineEnds& ends, const Areas& corner_factors) {
    // Codes: 1 above, 3 below, 4 both. An end with both is taken for the opposite of the other end.
    const auto side = [](int code) { return code == 1 ? 1 : code == 3 ? -1 : 0; };
    const int first = side(ends.left_code), last = side(ends.right_code);
    pixel[count] = at, factors[count] = corner_factors;
    from[count] = static_cast<float>(ends.left_code == 4 ? -last : first);
    to[count] = static_cast<float>(ends.right_code == 4 ? -first : last);
    left[count] = static_cast<float>(std::abs(ends.before)), right[count] = static_cast<float>(std::abs(ends.after));
    is_corner[count] = line.has_corner(ends, first) ? 1.0f : 0.0f;
    ++count;
  }
};

/// Pixels at diagonals that rise, or at those that fall.
struct DiagonalLists {
  std::size_t count = 0;
  std::array<std::size_t, capacity> pixel;
  std::array<std::int32_t, capacity> lines;
  std::array<float, capacity> left, right;

  void add(std::size_t at, const DiagonalEnds& ends, const std::array<std::int32_t, 16>& lines_of) {
    pixel[count] = at, lines[count] = lines_of[static_cast<std::size_t>(4 * ends.left_code + ends.right_code)];
    left[count] = static_cast<float>(ends.left), right[count] = static_cast<float>(ends.right);
    ++count;
  }
};

class Collected {
 public:
  Collected(float2 offset, WeightRow& out) : offset_(offset), out_(out) {}

  void add(int x, const std::uint8_t* pixel, std::ptrdiff_t stride, const SmaaSearches& searches,
           const SmaaOptions& options) {
    if (count_ == capacity) finish();
    const std::size_t at = count_++;
    x_[at] = x, top_[at] = {}, left_[at] = {};
    if (*pixel & top_edge) {
      const Diagonals diagonals(pixel, stride, options.diagonal_steps);
      std::optional<DiagonalEnds> rising, falling;
      if (options.diagonal_steps > 0) rising = diagonals.rising(), falling = diagonals.falling();
      if (rising) rising_.add(at, *rising, searches.diagonal_lines);
      if (falling) falling_.add(at, *falling, searches.diagonal_lines);
      if (rising || falling) return;
      add_line(tops_, at, EdgeLine<top_edge>(pixel, stride), searches.along_top, options);
    }
    if (*pixel & left_edge) add_line(lefts_, at, EdgeLine<left_edge>(pixel, stride), searches.along_left, options);
  }

  /// Computes the areas of the pixels that have been added, and stores their weights.
  void finish() {
    finish(tops_, {offset_.x, -offset_.y}, top_);
    finish(lefts_, {offset_.y, -offset_.x}, left_);
    // Diagonals that fall are seen in a mirror, in which they rise.
    finish(rising_, {offset_.x, -offset_.y},
           [&](std::size_t at, float below, float above) { top_[at].from += below, top_[at].to += above; });
    finish(falling_, offset_,
           [&](std::size_t at, float below, float above) { top_[at].from += above, top_[at].to += below; });
    const auto weight = [](float area) { return round_unorm8(std::min(area, 1.0f) * 255); };
    for (std::size_t i = 0; i < count_; ++i)
      out_.set(x_[i], {weight(top_[i].from), weight(top_[i].to), weight(left_[i].from), weight(left_[i].to)});
    count_ = 0;
  }

 private:
  template <class Of>
  static void add_line(Lines& lines, std::size_t at, const Of& line, const SearchSteps& steps,
                       const SmaaOptions& options) {
    const LineEnds ends = line.ends(steps, options.steps);
    if (ends.left_code + ends.right_code == 0) return;
    const bool has_corners = options.corner_rounding < 100;
    const float strength = 1 - static_cast<float>(options.corner_rounding) / 100;
    lines.add(at, line, ends, has_corners ? line.corner_factors(ends, strength, false) : Areas{1, 1});
  }

  void finish(Lines& lines, float2 offset, std::array<Areas, capacity>& out) {
    AreaKernels::of().orthogonal(
        {lines.from.data(), lines.to.data(), lines.left.data(), lines.right.data(), lines.is_corner.data()}, offset,
        below_.data(), above_.data(), lines.count);
    for (std::size_t i = 0; i < lines.count; ++i)
      out[lines.pixel[i]] = {below_[i] * lines.factors[i].from, above_[i] * lines.factors[i].to};
    lines.count = 0;
  }
  template <class Add>
  void finish(DiagonalLists& list, float2 offset, const Add& add) {
    AreaKernels::of().diagonal({list.lines.data(), list.left.data(), list.right.data()}, offset, below_.data(),
                               above_.data(), list.count);
    for (std::size_t i = 0; i < list.count; ++i) add(list.pixel[i], below_[i], above_[i]);
    list.count = 0;
  }

  float2 offset_;
  WeightRow& out_;
  std::size_t count_ = 0;
  std::array<int, capacity> x_;
  std::array<Areas, capacity> top_, left_;
  Lines tops_, lefts_;
  DiagonalLists rising_, falling_;
  std::array<float, capacity> below_, above_;
};

}  // namespace

void compute_exact_weights(const EdgePlane& edges, int y, const SmaaSearches& searches, const SmaaOptions& options,
                           WeightRow& out) {
  Collected collected(*options.exact_offset, out);
  const std::uint8_t* row = edges.at(0, y);
  for_edges(edges, y, [&](int x) { collected.add(x, row + x, edges.stride(), searches, options); });
  collected.finish();
}

}  // namespace zoneplate::antialias
