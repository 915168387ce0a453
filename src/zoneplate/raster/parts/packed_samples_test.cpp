// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/parts/packed_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/math/random.h"
#include "zoneplate/raster/tile/visibility.h"

namespace zoneplate {
namespace {

constexpr int sample_count = 3;

/// A tile some of whose samples a rank owns: nothing in the last block, and everything in the first.
void fill(std::uint32_t seed, TileVisibility& tile) {
  tile.sample_count = sample_count;
  tile.clear();
  for (int block = 0; block + 1 < TileVisibility::blocks; ++block) {
    if (block > 0 && hash(seed, static_cast<std::uint32_t>(block)) % 3 == 0) continue;
    tile.materialize_block(block);
    for (int s = 0; s < sample_count; ++s)
      for (int i = 0; i < 64; ++i) {
        const std::uint32_t at = static_cast<std::uint32_t>(s) * sample_stride + pixel_in_tile(block, i);
        const std::uint32_t value = hash(hash(seed, at), 1);
        if (block > 0 && value % 4 == 0) continue;
        tile.depth[at] = static_cast<float>(value / 4 % 8) / 8;  // ties are frequent
        tile.id[at] = block == 1 ? static_cast<std::int32_t>(seed) : static_cast<std::int32_t>(value / 64 % 1000);
      }
  }
}

ByteBuffer packed(const TileVisibility& tile, const SampleSet* only = nullptr) {
  ByteBuffer out;
  pack_samples(tile, only, out);
  return out;
}

void begin(TileVisibility& tile) {
  tile.sample_count = sample_count;
  tile.clear();
}

void expect_same(TileVisibility& a, TileVisibility& b) {
  a.materialize_all(), b.materialize_all();
  for (int s = 0; s < sample_count; ++s)
    for (int p = 0; p < tile_pixels; ++p) {
      ASSERT_EQ(a.id[s * sample_stride + p], b.id[s * sample_stride + p]);
      ASSERT_EQ(a.depth[s * sample_stride + p], b.depth[s * sample_stride + p]);
    }
}

TEST(PackedSamples, UnpackTheSamplesThatWerePacked) {
  VisibilityBuffer tile(sample_count), copy(sample_count);
  fill(1, tile), begin(copy);
  merge_samples(packed(tile).bytes(), nullptr, 0, copy, nullptr);
  expect_same(tile, copy);
}

TEST(PackedSamples, MergeToTheNearestOfTheLowestIdInAnyOrder) {
  std::vector<std::uint32_t> order = {1, 2, 3, 4};
  VisibilityBuffer expected(sample_count), tile(sample_count);
  begin(expected);
  expected.materialize_all();
  std::vector<ByteBuffer> parts;
  for (const std::uint32_t seed : order) {
    fill(seed, tile);
    parts.push_back(packed(tile));
    tile.materialize_all();
    for (std::uint32_t at = 0; at < sample_count * tile_pixels; ++at) {
      const std::uint32_t i = sample_place(at);
      const bool is_nearer =
          tile.depth[i] > expected.depth[i] || (tile.depth[i] == expected.depth[i] && tile.id[i] < expected.id[i]);
      if (is_nearer) expected.depth[i] = tile.depth[i], expected.id[i] = tile.id[i];
    }
  }
  do {
    VisibilityBuffer merged(sample_count);
    begin(merged);
    for (const std::uint32_t seed : order) merge_samples(parts[seed - 1].bytes(), nullptr, 0, merged, nullptr);
    expect_same(expected, merged);
  } while (std::ranges::next_permutation(order).found);
}

TEST(PackedSamples, SetsByPartDivideTheOwnedSamples) {
  VisibilityBuffer tile(sample_count), merged(sample_count), again(sample_count);
  begin(merged);
  std::vector<std::uint16_t> numbers(sample_count * sample_stride);
  std::vector<ByteBuffer> parts;
  for (std::uint16_t part = 0; part < 3; ++part) {
    fill(part + 1, tile);
    parts.push_back(packed(tile));
    merge_samples(parts.back().bytes(), nullptr, part, merged, numbers.data());
  }
  const std::vector<SampleSet> sets = samples_by_part(merged, numbers, 3);
  for (int s = 0; s < sample_count; ++s)
    for (int block = 0; block < TileVisibility::blocks; ++block) {
      EXPECT_EQ(sets[0].of(s, block) & sets[1].of(s, block), 0u);
      EXPECT_EQ((sets[0].of(s, block) | sets[1].of(s, block)) & sets[2].of(s, block), 0u);
    }
  begin(again);
  for (std::uint16_t part = 0; part < 3; ++part) merge_samples(parts[part].bytes(), &sets[part], 0, again, nullptr);
  expect_same(merged, again);
  begin(again);
  for (const SampleSet& set : sets) merge_samples(packed(merged, &set).bytes(), nullptr, 0, again, nullptr);
  expect_same(merged, again);
}

TEST(PackedSamples, TakeFewBytesWhereTheyAreAlike) {
  VisibilityBuffer tile(1), copy(1);
  tile.sample_count = copy.sample_count = 1;
  tile.clear();
  EXPECT_EQ(packed(tile).size(), 0u);
  tile.materialize_all();
  EXPECT_EQ(packed(tile).size(), 0u);
  const auto expect_bytes = [&](std::size_t of_depth, std::size_t of_id) {
    const ByteBuffer bytes = packed(tile);
    EXPECT_EQ(bytes.size(), 64 * (sizeof(PackedBlock) + of_depth + of_id));
    copy.clear();
    merge_samples(bytes.bytes(), nullptr, 0, copy, nullptr);
    for (int p = 0; p < tile_pixels; ++p) {
      ASSERT_EQ(tile.id[p], copy.id[p]);
      ASSERT_EQ(tile.depth[p], copy.depth[p]);
    }
  };
  std::fill_n(tile.id, tile_pixels, 7);
  expect_bytes(4, 4);
  for (int p = 0; p < tile_pixels; ++p) tile.depth[p] = 0.5f + 0x1p-24f * static_cast<float>(p);
  expect_bytes(4 + 64 * 2, 4);
  for (int p = 0; p < tile_pixels; ++p) tile.id[p] = 2'000'000'000 + 16 * p;
  expect_bytes(4 + 64 * 2, 4 + 64 * 2);
  for (int p = 0; p < tile_pixels; ++p) tile.id[p] = 100'000 * p, tile.depth[p] = 1 / static_cast<float>(1 + p);
  expect_bytes(64 * 4, 64 * 4);
}

TEST(PackedSamples, ChangedSamplesAreThoseOfAnotherId) {
  VisibilityBuffer tile(sample_count);
  fill(5, tile);
  tile.materialize_all();
  const std::vector<std::int32_t> before(tile.id, tile.id + sample_count * sample_stride);
  EXPECT_TRUE(changed_samples(tile, before).is_empty());
  tile.id[sample_stride + pixel_in_tile(9, 20)] = 1234;
  const SampleSet changed = changed_samples(tile, before);
  EXPECT_EQ(changed.of(1, 9), std::uint64_t{1} << 20);
  EXPECT_EQ(changed.of(0, 9), 0u);
}

}  // namespace
}  // namespace zoneplate
