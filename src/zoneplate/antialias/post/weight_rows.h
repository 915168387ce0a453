// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "zoneplate/antialias/post/result_row.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {

/// The weights of blending across a pixel's upper and left borders, in both directions, in 1/255.
struct EdgeWeights {
  std::uint8_t from_above = 0;  ///< weight of the pixel above in this one
  std::uint8_t to_above = 0;    ///< weight of this pixel in the one above
  std::uint8_t from_left = 0, to_left = 0;
  bool operator==(const EdgeWeights&) const = default;
};

/// The weights of a pixel's four neighbours in it, in 1/255.
struct TakenWeights {
  std::uint8_t above, below, left, right;
};

/// A row of weights, most of which are zero, with a flag for each block that has others.
///
/// Edges     the last pixel's weights are repeated beyond it.
class WeightRow {
 public:
  static constexpr int together = 8;  ///< pixels of a block

  explicit WeightRow(int width) : width_(width), values_(size_of(width) * together), has_any_(size_of(width)) {}

  void clear() {
    for (std::size_t block = 0; block < has_any_.size(); ++block) {
      if (!has_any_[block]) continue;
      std::fill_n(&values_[block * together], together, EdgeWeights{});
      has_any_[block] = 0;
    }
  }
  void set(int x, EdgeWeights weights) {
    values_[static_cast<std::size_t>(x)] = weights;
    has_any_[static_cast<std::size_t>(x / together)] |= weights != EdgeWeights{};
    if (x == width_ - 1) set_beyond(weights);
  }
  /// Sets all weights of the row.
  void assign(const EdgeWeights* weights) {
    std::memcpy(values_.data(), weights, sizeof(EdgeWeights) * static_cast<std::size_t>(width_));
    for (std::size_t block = 0; block * together < static_cast<std::size_t>(width_); ++block) {
      std::uint64_t pairs[together / 2];
      std::memcpy(pairs, &values_[block * together], sizeof pairs);
      has_any_[block] = (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
    }
    set_beyond(values_[static_cast<std::size_t>(width_ - 1)]);
  }
  const EdgeWeights& operator[](int x) const { return values_[static_cast<std::size_t>(x)]; }
  /// False if all weights of a block are zero.
  bool has_any(int block) const { return has_any_[static_cast<std::size_t>(block)] != 0; }

 private:
  static std::size_t size_of(int width) { return static_cast<std::size_t>(width / together + 2); }
  void set_beyond(EdgeWeights weights) {
    values_[static_cast<std::size_t>(width_)] = weights;
    has_any_[static_cast<std::size_t>(width_ / together)] |= weights != EdgeWeights{};
  }

  int width_;
  std::vector<EdgeWeights> values_;
  std::vector<std::uint8_t> has_any_;
};

/// The last pass of SMAA and MLAA: out(x, y) is mix(x, y, taken) if any weight is not zero, otherwise image(x, y).
///
/// `weigh(y, row)` stores a row's weights in a cleared row; it is called once or twice for each row.
template <class Weigh, class Mix>
void mix_by_weights(const Rgba8Image& image, Rgba8Image& out, const Weigh& weigh, const Mix& mix) {
  constexpr std::size_t rows = 32;
  const int width = image.width(), height = image.height();
  const auto mix_row = [&](int y, const WeightRow& row, const WeightRow& next, std::span<Rgba8> to) {
    for (int block = 0; WeightRow::together * block < width; ++block) {
      if (!row.has_any(block) && !row.has_any(block + 1) && !next.has_any(block)) continue;
      const int begin = WeightRow::together * block, end = std::min(begin + WeightRow::together, width);
      for (int x = begin; x < end; ++x) {
        const TakenWeights taken{row[x].from_above, next[x].to_above, row[x].from_left, row[x + 1].to_left};
        if (std::bit_cast<std::uint32_t>(taken) != 0) to[static_cast<std::size_t>(x)] = mix(x, y, taken);
      }
    }
  };
  parallel_ranges(static_cast<std::size_t>(height), rows, [&](std::size_t begin, std::size_t end) {
    WeightRow here(width), next(width);
    ResultRow result(image, out);
    const auto make = [&](int y, WeightRow& row) {
      row.clear();
      weigh(std::min(y, height - 1), row);
    };
    make(static_cast<int>(begin), here);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      make(y + 1, next);
      mix_row(y, here, next, result.begin(y));
      result.end();
      std::swap(here, next);
    }
  });
}

}  // namespace zoneplate::antialias
