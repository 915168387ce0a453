// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/raster/geometry/draw.h"

namespace zoneplate {

/// How the triangles of draws that every rank has are distributed over the ranks.
enum class Partition {
  Node,         ///< whole draws, in their order: about as many triangles for each rank
  Index,        ///< as many consecutive triangles for each rank
  Interleaved,  ///< runs of 64 triangles, each for a rank that a hash chooses
};

/// Consecutive triangles of one rank, up to the id `end`.
struct TriangleRun {
  std::int64_t end;
  int rank;
};

/// The runs of a partition, in the order of their triangles, which are all those of the draws.
std::vector<TriangleRun> runs_of(std::span<const Draw> draws, Partition partition, int ranks);

/// The draws of one rank: those of all triangles in their order, where the triangles of other ranks are `elsewhere`.
/// Draws of lines and points are not divided: the rank of the first triangle has them.
///
/// Requires  the runs hold the triangles of all draws.
std::vector<Draw> draws_of_rank(std::span<const Draw> draws, std::span<const TriangleRun> runs, int rank);

}  // namespace zoneplate
