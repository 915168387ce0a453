// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/base/ranks/byte_buffer.h"
#include "zoneplate/raster/coverage/coverage.h"

namespace zoneplate {

/// A set of samples of a tile: for each sample of the pattern and each block, a bit for each pixel of the block.
class SampleSet {
 public:
  explicit SampleSet(int samples = 0) : bits_(static_cast<std::size_t>(samples) * TileVisibility::blocks) {}
  std::uint64_t& of(int sample, int block) { return bits_[at(sample, block)]; }
  std::uint64_t of(int sample, int block) const { return bits_[at(sample, block)]; }
  bool is_empty() const;
  std::span<std::uint64_t> bits() { return bits_; }
  std::span<const std::uint64_t> bits() const { return bits_; }

 private:
  static std::size_t at(int sample, int block) {
    return static_cast<std::size_t>(sample) * TileVisibility::blocks + static_cast<std::size_t>(block);
  }
  std::vector<std::uint64_t> bits_;
};

/// Appends the samples that have an owner, with depth and id: nothing for empty blocks, and one id for a block that one
/// triangle owns. Ids, and the bits of depths, that lie within 65536 are stored as differences of 16 bits: mostly, a
/// sample takes four bytes.
///
/// `only`: samples of other sets are left out; null: none are.
void pack_samples(const TileVisibility& tile, const SampleSet* only, ByteBuffer& out);

/// Merges packed samples into a tile by (depth, id): a sample takes the owner that comes first. Those that are taken
/// are of `part` in `parts`, unless that is null. Blocks that are touched are materialized.
///
/// Exact     the order of merging changes nothing.
void merge_samples(std::span<const std::byte> packed, const SampleSet* only, std::uint16_t part, TileVisibility& tile,
                   std::uint16_t* parts);

/// Calls use(sample, pixel, depth, id) for each packed sample.
template <class Use>
void for_packed_samples(std::span<const std::byte> packed, Use use);

/// The samples of each of `count` parts of a tile.
std::vector<SampleSet> samples_by_part(const TileVisibility& tile, std::span<const std::uint16_t> parts,
                                       std::size_t count);

/// The samples whose owner is another one than in `before`, which holds the ids by sample.
SampleSet changed_samples(const TileVisibility& tile, std::span<const std::int32_t> before);

/// The samples of one block and one sample of the pattern. Their depths follow, then their ids.
struct PackedBlock {
  std::uint16_t sample;
  std::uint8_t block;
  std::uint8_t depth_bytes : 4, id_bytes : 4;  ///< of each: 0 if all are equal, 2 if they are differences, or 4
  std::uint32_t count;
  std::uint64_t pixels;  ///< of the block
};

/// The bits of a block's depths and its ids, by sample of the block.
struct BlockSamples {
  std::uint32_t depth[64], id[64];
};

/// The most bytes that pack_samples appends for a tile.
constexpr std::size_t max_packed_bytes(int samples) {
  return static_cast<std::size_t>(samples) * TileVisibility::blocks * (sizeof(PackedBlock) + sizeof(BlockSamples));
}

/// Reads what follows the head of a block.
BlockSamples read_samples(const PackedBlock& head, ByteReader& reader);

/// The place of pixel i of a block, in planes of a tile.
constexpr std::uint32_t pixel_in_tile(int block, int i) {
  return static_cast<std::uint32_t>((block / 8 * 8 + i / 8) * tile_size + block % 8 * 8 + i % 8);
}

template <class Use>
void for_packed_samples(std::span<const std::byte> packed, Use use) {
  ByteReader reader(packed);
  while (!reader.is_at_end()) {
    const auto head = reader.take<PackedBlock>();
    const BlockSamples samples = read_samples(head, reader);
    std::size_t i = 0;
    for (std::uint64_t left = head.pixels; left; left &= left - 1, ++i)
      use(int{head.sample}, pixel_in_tile(head.block, std::countr_zero(left)), std::bit_cast<float>(samples.depth[i]),
          static_cast<std::int32_t>(samples.id[i]));
  }
}

}  // namespace zoneplate
