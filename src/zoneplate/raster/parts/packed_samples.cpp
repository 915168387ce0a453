// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/parts/packed_samples.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace zoneplate {
namespace {

constexpr int edge = 8, pixels_of_block = edge * edge;
constexpr std::size_t most_bytes = sizeof(PackedBlock) + pixels_of_block * (sizeof(float) + sizeof(std::int32_t));

/// The place of a block's first pixel in the planes.
std::size_t corner_of(int sample, int block) {
  return static_cast<std::size_t>(sample) * sample_stride + pixel_in_tile(block, 0);
}

/// The pixels of a block that have an owner, and whether all pixels of the block have the same.
struct BlockOwners {
  std::uint64_t pixels;
  bool is_one;
};
BlockOwners owners_of(const std::int32_t* id) {
  std::uint32_t different = 0, empty = 0;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const std::int32_t of = id[y * tile_size + x];
      different |= static_cast<std::uint32_t>(of ^ id[0]);
      empty += of == no_primitive ? 1u : 0u;
    }
  if (empty == 0) return {~std::uint64_t{0}, different == 0};
  std::uint64_t pixels = 0;
  if (empty < pixels_of_block)
    for (int i = 0; i < pixels_of_block; ++i)
      pixels |= std::uint64_t{id[i / edge * tile_size + i % edge] != no_primitive} << i;
  return {pixels, false};
}

/// Whether all pixels of a block are of one part.
bool is_one_part(const std::uint16_t* parts) {
  unsigned different = 0;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) different |= static_cast<unsigned>(parts[y * tile_size + x] ^ parts[0]);
  return different == 0;
}

/// Writes the chosen values of a block one after the other, and returns the end of what is written.
template <class T>
std::byte* gather(const T* plane, std::uint64_t pixels, std::byte* out) {
  if (pixels == ~std::uint64_t{0}) {
    for (int y = 0; y < edge; ++y, out += edge * sizeof(T)) std::memcpy(out, plane + y * tile_size, edge * sizeof(T));
    return out;
  }
  for (std::uint64_t left = pixels; left; left &= left - 1, out += sizeof(T))
    std::memcpy(out, plane + pixel_in_tile(0, std::countr_zero(left)), sizeof(T));
  return out;
}

/// The inverse of gather: values of the pixels that are not chosen stay undefined.
template <class T>
void scatter(const std::byte* packed, std::uint64_t pixels, T (&out)[pixels_of_block]) {
  if (pixels == ~std::uint64_t{0}) {
    std::memcpy(out, packed, sizeof out);
    return;
  }
  for (std::uint64_t left = pixels; left; left &= left - 1, packed += sizeof(T))
    std::memcpy(&out[std::countr_zero(left)], packed, sizeof(T));
}

void merge_block(const float* z, const std::int32_t* t, std::uint16_t part, float* depth, std::int32_t* id,
                 std::uint16_t* parts) {
  for (int y = 0; y < edge; ++y, z += edge, t += edge, depth += tile_size, id += tile_size) {
    std::int32_t wins[edge];
    for (int x = 0; x < edge; ++x)
      wins[x] = (z[x] > depth[x] ? 1 : 0) | ((z[x] == depth[x] ? 1 : 0) & (t[x] < id[x] ? 1 : 0));
    for (int x = 0; x < edge; ++x) depth[x] = wins[x] ? z[x] : depth[x];
    for (int x = 0; x < edge; ++x) id[x] = wins[x] ? t[x] : id[x];
    if (!parts) continue;
    for (int x = 0; x < edge; ++x) parts[x] = wins[x] ? part : parts[x];
    parts += tile_size;
  }
}

}  // namespace

bool SampleSet::is_empty() const {
  return std::ranges::all_of(bits_, [](std::uint64_t bits) { return bits == 0; });
}

void pack_samples(const TileVisibility& tile, const SampleSet* only, ByteBuffer& out) {
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    if (tile.block_primitive[block] == no_primitive) continue;
    for (int s = 0; s < tile.sample_count; ++s) {
      const std::size_t corner = corner_of(s, block);
      const std::uint64_t wanted = only ? only->of(s, block) : ~std::uint64_t{0};
      if (wanted == 0) continue;
      const BlockOwners owners = owners_of(tile.id + corner);
      const std::uint64_t pixels = owners.pixels & wanted;
      if (pixels == 0) continue;
      const PackedBlock head{.sample = static_cast<std::uint16_t>(s),
                             .block = static_cast<std::uint8_t>(block),
                             .has_one_id = owners.is_one,
                             .count = static_cast<std::uint32_t>(std::popcount(pixels)),
                             .pixels = pixels};
      std::byte* const begin = out.reserve(most_bytes);
      std::memcpy(begin, &head, sizeof head);
      std::byte* end = gather(tile.depth + corner, pixels, begin + sizeof head);
      end = gather(tile.id + corner, owners.is_one ? pixels & (~pixels + 1) : pixels, end);
      out.keep(static_cast<std::size_t>(end - begin));
    }
  }
}

void merge_samples(std::span<const std::byte> packed, const SampleSet* only, std::uint16_t part, TileVisibility& tile,
                   std::uint16_t* parts) {
  ByteReader reader(packed);
  float z[pixels_of_block];
  std::int32_t t[pixels_of_block];
  while (!reader.is_at_end()) {
    const auto head = reader.take<PackedBlock>();
    const std::byte* const depths = reader.take(head.count * sizeof(float)).data();
    const std::byte* const ids = reader.take((head.has_one_id ? 1 : head.count) * sizeof(std::int32_t)).data();
    const std::uint64_t wanted = only ? head.pixels & only->of(head.sample, head.block) : head.pixels;
    if (wanted == 0) continue;
    if (wanted != ~std::uint64_t{0}) std::fill_n(z, pixels_of_block, -1.0f);  // behind everything
    scatter(depths, head.pixels, z);
    if (head.has_one_id) {
      std::int32_t one;
      std::memcpy(&one, ids, sizeof one);
      std::fill_n(t, pixels_of_block, one);
    } else {
      if (head.pixels != ~std::uint64_t{0}) std::fill_n(t, pixels_of_block, no_primitive);
      scatter(ids, head.pixels, t);
    }
    for (std::uint64_t left = head.pixels & ~wanted; left; left &= left - 1) z[std::countr_zero(left)] = -1;
    if (tile.block_primitive[head.block] != mixed_primitives) tile.materialize_block(head.block);
    const std::size_t corner = corner_of(head.sample, head.block);
    merge_block(z, t, part, tile.depth + corner, tile.id + corner, parts ? parts + corner : nullptr);
  }
}

std::vector<SampleSet> samples_by_part(const TileVisibility& tile, std::span<const std::uint16_t> parts,
                                       std::size_t count) {
  std::vector<SampleSet> sets(count, SampleSet(tile.sample_count));
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    if (tile.block_primitive[block] == no_primitive) continue;
    for (int s = 0; s < tile.sample_count; ++s) {
      const std::size_t corner = corner_of(s, block);
      std::uint64_t left = owners_of(tile.id + corner).pixels;
      if (left == ~std::uint64_t{0} && is_one_part(&parts[corner])) {
        sets[parts[corner]].of(s, block) = left;
        continue;
      }
      while (left) {
        const std::uint16_t part = parts[corner + pixel_in_tile(0, std::countr_zero(left))];
        std::uint64_t same = 0;
        for (int i = 0; i < pixels_of_block; ++i)
          same |= std::uint64_t{parts[corner + pixel_in_tile(0, i)] == part} << i;
        sets[part].of(s, block) = same & left;
        left &= ~same;
      }
    }
  }
  return sets;
}

SampleSet changed_samples(const TileVisibility& tile, std::span<const std::int32_t> before) {
  SampleSet changed(tile.sample_count);
  for (int block = 0; block < TileVisibility::blocks; ++block)
    for (int s = 0; s < tile.sample_count; ++s) {
      const std::size_t corner = corner_of(s, block);
      std::uint64_t pixels = 0;
      for (int i = 0; i < pixels_of_block; ++i)
        pixels |= std::uint64_t{tile.id[corner + pixel_in_tile(0, i)] != before[corner + pixel_in_tile(0, i)]} << i;
      changed.of(s, block) = pixels;
    }
  return changed;
}

}  // namespace zoneplate
