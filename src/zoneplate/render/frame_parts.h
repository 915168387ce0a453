// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/raster/parts/partition.h"
#include "zoneplate/raster/parts/rasterize_parts.h"
#include "zoneplate/render/backend.h"

namespace zoneplate {

/// The ranks that render frames together, and how the triangles are distributed over them.
struct FrameParts {
  Ranks& ranks;
  /// Where every rank has the whole scene: which of its triangles each rank draws.
  Partition partition = Partition::Index;
  /// Where each rank has a part of the scene: by instance, the triangles that other ranks have. Empty: every rank has
  /// the whole scene.
  std::vector<std::uint32_t> elsewhere = {};
  PartTimes* times = nullptr;  ///< of this rank; null: not needed
};

/// The rasterizer on the CPU with a part of the triangles on each rank (raster/parts/rasterize_parts.h): every rank
/// renders the same frames. Their planes are complete on rank 0; on every rank, if the request does not resolve per
/// pixel, since a method may choose its next request by them.
///
/// Methods that draw for themselves (Request::draw), shadows and occlusion require the whole scene on every rank. Such
/// a method draws a strip of the image on each.
/// Errors    ErrorKind::Usage naming what a part of the scene does not suffice for.
std::unique_ptr<Backend> make_cpu_backend(FrameParts parts);

/// Gives the ranks what they hold of a frame: pixels that are not 0 in `held`. `data`: of its data planes, otherwise of
/// colours, coverage and planes by sample. To every rank, or to rank 0 alone.
void gather(Ranks& ranks, const Plane<std::uint8_t>& held, bool data, bool to_every_rank, Frame& frame);

}  // namespace zoneplate
