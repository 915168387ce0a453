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

/// Rewrites the list with only the nearest fragment of each sample. This is repeated when the list has doubled.
void TileSampleBins::drop_hidden(std::size_t tile, Arena& arena) {
  compute_nearest(last_[tile]);
  while (SampleBin* const part = last_[tile]) {
    last_[tile] = part->previous;
    part->previous = free_;
    free_ = part;
  }
  parts_[tile] = 0;
  // The ids of a part lie within max_ids.
  std::sort(nearest_.begin(), nearest_.end(),
            [](const Nearest& p, const Nearest& q) { return p.id != q.id ? p.id < q.id : p.at < q.at; });
  SampleBin* part = nullptr;
  for (const Nearest& n : nearest_) {
    if (!part || part->count == SampleBin::capacity || n.id - part->first_id > SampleBin::max_ids)
      part = add_part(tile, n.id, arena);
    part->depth[part->count] = n.depth;
    part->packed[part->count++] = (static_cast<std::uint32_t>(n.id - part->first_id) << 16) + n.at;
  }
  limit_[tile] = std::max(enough, 2 * parts_[tile]);
}

/// Fills nearest_ with the visible fragment of each sample: the least (-depth, id).
void TileSampleBins::compute_nearest(const SampleBin* list) {
  number_.assign(static_cast<std::size_t>(samples_) * tile_pixels, 0);
  nearest_.clear();
  for (; list; list = list->previous)
    for (std::int32_t i = 0; i < list->count; ++i) {
      const Nearest found{list->depth[i], list->id(list->packed[i]), SampleBin::at(list->packed[i])};
      std::uint32_t& number = number_[found.at];
      if (number == 0) {
        nearest_.push_back(found);
        number = static_cast<std::uint32_t>(nearest_.size());
        continue;
      }
      Nearest& before = nearest_[number - 1];
      if (found.depth > before.depth || (found.depth == before.depth && found.id < before.id)) before = found;
    }
}

}  // namespace zoneplate
