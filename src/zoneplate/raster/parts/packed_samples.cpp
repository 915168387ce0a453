// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/parts/packed_samples.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace zoneplate {
namespace {

constexpr int edge = 8, pixels_of_block = edge * edge;
constexpr std::size_t max_bytes = sizeof(PackedBlock) + sizeof(BlockSamples);

/// The place of a block's first pixel in the planes.
std::size_t corner_of(int sample, int block) {
  return static_cast<std::size_t>(sample) * sample_stride + pixel_in_tile(block, 0);
}

/// The pixels of a block that have an owner.
std::uint64_t owned_pixels(const std::int32_t* id) {
  std::uint32_t empty = 0;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) empty += id[y * tile_size + x] == no_primitive ? 1u : 0u;
  if (empty == 0) return ~std::uint64_t{0};
  std::uint64_t pixels = 0;
  if (empty < pixels_of_block)
    for (int i = 0; i < pixels_of_block; ++i)
      pixels |= std::uint64_t{id[i / edge * tile_size + i % edge] != no_primitive} << i;
  return pixels;
}

/// Whether all pixels of a block are of one part.
bool is_one_part(const std::uint16_t* parts) {
  unsigned different = 0;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) different |= static_cast<unsigned>(parts[y * tile_size + x] ^ parts[0]);
  return different == 0;
}

/// The chosen values of a block one after the other.
template <class T>
void gather(const T* plane, std::uint64_t pixels, std::uint32_t (&out)[pixels_of_block]) {
  static_assert(sizeof(T) == sizeof(std::uint32_t));
  if (pixels == ~std::uint64_t{0}) {
    for (int y = 0; y < edge; ++y) std::memcpy(out + y * edge, plane + y * tile_size, edge * sizeof(T));
    return;
  }
  std::uint32_t* to = out;
  for (std::uint64_t left = pixels; left; left &= left - 1)
    std::memcpy(to++, plane + pixel_in_tile(0, std::countr_zero(left)), sizeof(T));
}

/// The inverse: values of the pixels that are not chosen stay as they are.
template <class T>
void scatter(const std::uint32_t (&packed)[pixels_of_block], std::uint64_t pixels, T (&out)[pixels_of_block]) {
  if (pixels == ~std::uint64_t{0}) {
    std::memcpy(out, packed, sizeof out);
    return;
  }
  const std::uint32_t* from = packed;
  for (std::uint64_t left = pixels; left; left &= left - 1)
    std::memcpy(&out[std::countr_zero(left)], from++, sizeof(T));
}

/// Writes values, and returns their bytes each; `out` moves to the end.
std::uint8_t write_values(const std::uint32_t* values, std::uint32_t count, std::byte*& out) {
  std::uint32_t least = values[0], greatest = values[0];
  for (std::uint32_t i = 0; i < count; ++i) {
    least = values[i] < least ? values[i] : least;
    greatest = values[i] > greatest ? values[i] : greatest;
  }
  if (greatest - least > 0xffff) {
    std::memcpy(out, values, count * sizeof(std::uint32_t));
    out += count * sizeof(std::uint32_t);
    return 4;
  }
  std::memcpy(out, &least, sizeof least);
  out += sizeof least;
  if (greatest == least) return 0;
  std::uint16_t differences[pixels_of_block];
  for (std::uint32_t i = 0; i < count; ++i) differences[i] = static_cast<std::uint16_t>(values[i] - least);
  std::memcpy(out, differences, count * sizeof(std::uint16_t));
  out += count * sizeof(std::uint16_t);
  return 2;
}

void read_values(std::uint8_t bytes, std::uint32_t count, ByteReader& reader, std::uint32_t* out) {
  if (bytes == 4) {
    std::memcpy(out, reader.take(count * sizeof(std::uint32_t)).data(), count * sizeof(std::uint32_t));
    return;
  }
  const auto least = reader.take<std::uint32_t>();
  if (bytes == 0) {
    std::fill_n(out, count, least);
    return;
  }
  std::uint16_t differences[pixels_of_block];
  std::memcpy(differences, reader.take(count * sizeof(std::uint16_t)).data(), count * sizeof(std::uint16_t));
  for (std::uint32_t i = 0; i < count; ++i) out[i] = least + differences[i];
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
      const std::uint64_t pixels = owned_pixels(tile.id + corner) & wanted;
      if (pixels == 0) continue;
      BlockSamples samples;
      gather(tile.depth + corner, pixels, samples.depth);
      gather(tile.id + corner, pixels, samples.id);
      const auto count = static_cast<std::uint32_t>(std::popcount(pixels));
      PackedBlock head{.sample = static_cast<std::uint16_t>(s),
                       .block = static_cast<std::uint8_t>(block),
                       .depth_bytes = 0,
                       .id_bytes = 0,
                       .count = count,
                       .pixels = pixels};
      std::byte* const begin = out.reserve(max_bytes);
      std::byte* end = begin + sizeof head;
      head.depth_bytes = write_values(samples.depth, count, end) & 15;
      head.id_bytes = write_values(samples.id, count, end) & 15;
      std::memcpy(begin, &head, sizeof head);
      out.keep(static_cast<std::size_t>(end - begin));
    }
  }
}

BlockSamples read_samples(const PackedBlock& head, ByteReader& reader) {
  BlockSamples samples;
  read_values(head.depth_bytes, head.count, reader, samples.depth);
  read_values(head.id_bytes, head.count, reader, samples.id);
  return samples;
}

void merge_samples(std::span<const std::byte> packed, const SampleSet* only, std::uint16_t part, TileVisibility& tile,
                   std::uint16_t* parts) {
  ByteReader reader(packed);
  float z[pixels_of_block];
  std::int32_t t[pixels_of_block];
  while (!reader.is_at_end()) {
    const auto head = reader.take<PackedBlock>();
    const BlockSamples samples = read_samples(head, reader);
    const std::uint64_t wanted = only ? head.pixels & only->of(head.sample, head.block) : head.pixels;
    if (wanted == 0) continue;
    if (wanted != ~std::uint64_t{0}) std::fill_n(z, pixels_of_block, -1.0f);  // behind everything
    scatter(samples.depth, head.pixels, z);
    if (head.pixels != ~std::uint64_t{0}) std::fill_n(t, pixels_of_block, no_primitive);
    scatter(samples.id, head.pixels, t);
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
      std::uint64_t left = owned_pixels(tile.id + corner);
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
