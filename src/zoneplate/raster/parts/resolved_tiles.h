// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "zoneplate/base/large_array.h"
#include "zoneplate/raster/parts/packed_samples.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

/// A tile that this rank resolves.
struct ResolvedTile {
  struct Part {
    int rank;
    std::uint32_t flags;  ///< of its TileMessage
    std::span<const std::byte> bytes;
  };
  TileVisibility visibility;
  std::uint16_t* parts;  ///< by sample, as the planes of `visibility`: an index into `samples`
  // What ranks have sent in this pass: the samples of opaque and of alpha-tested triangles, and colours.
  std::vector<Part> samples, tested, colors;
  TileColors sums;
  bool is_alone = false;  ///< another rank, or this one, draws it as a whole
  alignas(64) float block_min_depth[TileVisibility::blocks];
  std::int32_t block_primitive[TileVisibility::blocks];

  void begin() {
    sums.sum.assign(tile_pixels / 8, Linear8{});
    sums.coverage.assign(tile_pixels, 0.0f);
    is_alone = false;
  }
  std::size_t index_of(int rank) const {
    return static_cast<std::size_t>(std::ranges::find(samples, rank, &Part::rank) - samples.begin());
  }
  void merge(const Part& part) {
    merge_samples(part.bytes, nullptr, static_cast<std::uint16_t>(index_of(part.rank)), visibility, parts);
  }
};

/// The tiles of a band that this rank resolves, with the memory of their samples.
class ResolvedTiles {
 public:
  /// Prepares them for these tiles, in ascending order.
  void begin(std::vector<std::size_t> numbers, int max_samples) {
    numbers_ = std::move(numbers);
    const auto values = static_cast<std::size_t>(max_samples) * sample_stride;
    if (values_ < numbers_.size() * values) {
      values_ = numbers_.size() * values;
      depth_ = LargeArray<float>::unset(values_ + line);
      id_ = LargeArray<std::int32_t>::unset(values_ + line);
      parts_ = LargeArray<std::uint16_t>::unset(values_);
    }
    while (tiles_.size() < numbers_.size()) tiles_.push_back(std::make_unique<ResolvedTile>());
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      ResolvedTile& tile = *tiles_[i];
      tile.visibility.depth = aligned(depth_) + i * values;
      tile.visibility.id = aligned(id_) + i * values;
      tile.visibility.block_min_depth = tile.block_min_depth;
      tile.visibility.block_primitive = tile.block_primitive;
      tile.parts = parts_.data() + i * values;
    }
  }
  std::size_t size() const { return numbers_.size(); }
  std::size_t number(std::size_t i) const { return numbers_[i]; }
  ResolvedTile& operator[](std::size_t i) { return *tiles_[i]; }
  ResolvedTile& of(std::size_t tile) {
    return *tiles_[static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), tile) -
                                            numbers_.begin())];
  }

 private:
  static constexpr std::size_t line = 64;  ///< bytes: the alignment of planes that the kernels require

  template <class T>
  static T* aligned(LargeArray<T>& array) {
    const auto address = reinterpret_cast<std::uintptr_t>(array.data());
    return array.data() + (line - address % line) % line / sizeof(T);
  }

  std::vector<std::size_t> numbers_;
  std::vector<std::unique_ptr<ResolvedTile>> tiles_;
  std::size_t values_ = 0;
  LargeArray<float> depth_;
  LargeArray<std::int32_t> id_;
  LargeArray<std::uint16_t> parts_;
};

}  // namespace zoneplate
