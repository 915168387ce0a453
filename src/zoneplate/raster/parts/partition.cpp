// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/parts/partition.h"

#include <algorithm>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr std::int64_t interleaved_run = 64;

/// The triangles [first, first + count) of a draw, as a draw.
Draw part_of(const Draw& draw, std::size_t first, std::size_t count, bool is_own) {
  Draw part = draw;
  part.first_primitive = draw.first_primitive + static_cast<std::uint32_t>(draw.quads ? first / 2 : first);
  if (is_own) {
    part.index = draw.index.subspan(3 * first, 3 * count);
  } else {
    part.elsewhere = static_cast<std::uint32_t>(count);
    part.index = {}, part.position = {}, part.clip = {}, part.quads = nullptr;
  }
  return part;
}

}  // namespace

std::vector<TriangleRun> runs_of(std::span<const Draw> draws, Partition partition, int ranks) {
  std::int64_t total = 0;
  for (const Draw& draw : draws) total += static_cast<std::int64_t>(draw.triangles());
  std::vector<TriangleRun> runs;
  const auto rank_at = [&](std::int64_t place) {
    return static_cast<int>(std::min<std::int64_t>(place * ranks / std::max<std::int64_t>(total, 1), ranks - 1));
  };
  if (partition == Partition::Node) {
    std::int64_t first = 0;
    for (const Draw& draw : draws) {
      const auto count = static_cast<std::int64_t>(draw.triangles());
      runs.push_back({first + count, rank_at(first + count / 2)});
      first += count;
    }
  } else if (partition == Partition::Index) {
    for (int rank = 0; rank < ranks; ++rank) runs.push_back({total * (rank + 1) / ranks, rank});
  } else {
    for (std::int64_t first = 0; first < total; first += interleaved_run)
      runs.push_back(
          {std::min(first + interleaved_run, total),
           static_cast<int>(hash(static_cast<std::uint32_t>(first), 0) % static_cast<std::uint32_t>(ranks))});
  }
  return runs;
}

std::vector<Draw> draws_of_rank(std::span<const Draw> draws, std::span<const TriangleRun> runs, int rank) {
  std::vector<Draw> out;
  std::int64_t begin = 0;
  std::size_t run = 0;
  for (const Draw& draw : draws) {
    const auto count = static_cast<std::int64_t>(draw.triangles());
    const std::int64_t end = begin + count;
    bool has_vertices = false;
    for (std::int64_t at = begin; at < end;) {
      while (runs[run].end <= at) ++run;
      const bool is_own = runs[run].rank == rank;
      // Parts of other ranks that follow one another are one.
      std::int64_t last = draw.quads ? end : std::min(end, runs[run].end);
      for (std::size_t next = run + 1; last < end && !is_own && runs[next].rank != rank; ++next)
        last = std::min(end, runs[next].end);
      out.push_back(part_of(draw, static_cast<std::size_t>(at - begin), static_cast<std::size_t>(last - at), is_own));
      out.back().continues = has_vertices;
      has_vertices = has_vertices || is_own;
      at = last;
    }
    begin = end;
  }
  return out;
}

}  // namespace zoneplate
