// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/fragments.h"

#include <algorithm>

#include "zoneplate/raster/types/tile_grid.h"

namespace zoneplate {

void TileSampleBins::clear(std::size_t tiles, int samples, bool keeps_hidden) {
  last_.assign(tiles, nullptr);
  parts_.assign(tiles, 0);
  limit_.assign(tiles, enough);
  free_ = nullptr;
  samples_ = samples;
  keeps_hidden_ = keeps_hidden;
}

SampleBin* TileSampleBins::grow(std::size_t tile, std::int32_t first_id, Arena& arena) {
  if (parts_[tile] >= limit_[tile] && !keeps_hidden_) drop_hidden(tile, arena);
  return add_part(tile, first_id, arena);
}

SampleBin* TileSampleBins::add_part(std::size_t tile, std::int32_t first_id, Arena& arena) {
  SampleBin* part = free_;
  if (part) {
    free_ = part->previous;
  } else {
    part = reinterpret_cast<SampleBin*>(arena.take(sizeof(SampleBin)));
  }
  part->previous = last_[tile];
  part->count = 0;
  part->first_id = first_id;
  ++parts_[tile];
  return last_[tile] = part;
}

/// Rewrites the list with only the nearest fragment of each sample, in its order. This is repeated when the list has
/// doubled.
void TileSampleBins::drop_hidden(std::size_t tile, Arena& arena) {
  compute_nearest(last_[tile]);
  while (SampleBin* const part = last_[tile]) {
    last_[tile] = part->previous;
    part->previous = free_;
    free_ = part;
  }
  parts_[tile] = 0;
  SampleBin* part = nullptr;
  for (auto n = kept_.rbegin(); n != kept_.rend(); ++n) {
    // One unsigned comparison for ids on both sides of the part's.
    const auto after = [&] { return static_cast<std::uint32_t>(n->id) - static_cast<std::uint32_t>(part->first_id); };
    if (!part || part->count == SampleBin::capacity || after() > SampleBin::max_ids)
      part = add_part(tile, n->id, arena);
    part->depth[part->count] = n->depth;
    part->packed[part->count++] = (after() << 16) + n->at;
  }
  limit_[tile] = std::max(enough, 2 * parts_[tile]);
}

/// Fills kept_ with the visible fragment of each sample, the least (-depth, id), the last one of the list first.
void TileSampleBins::compute_nearest(const SampleBin* list) {
  nearest_.assign(static_cast<std::size_t>(samples_) * tile_pixels, {});
  for (const SampleBin* part = list; part; part = part->previous)
    for (std::int32_t i = 0; i < part->count; ++i) {
      const Owner found{part->depth[i], part->id(part->packed[i])};
      Owner& before = nearest_[SampleBin::at(part->packed[i])];
      if (found.depth > before.depth || (found.depth == before.depth && found.id < before.id)) before = found;
    }
  kept_.clear();
  for (const SampleBin* part = list; part; part = part->previous)
    for (std::int32_t i = part->count - 1; i >= 0; --i) {
      const std::int32_t id = part->id(part->packed[i]);
      const std::uint32_t at = SampleBin::at(part->packed[i]);
      if (nearest_[at].id == id) kept_.push_back({part->depth[i], id, at});
    }
}

}  // namespace zoneplate
