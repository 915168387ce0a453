// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/formats/obj/parse.h"

namespace zoneplate {

/// A range of elements of one chunk with the same state.
struct ObjRun {
  std::uint32_t chunk = 0, begin = 0, end = 0;  ///< elements
  int object = 0, material = 0;
  std::uint32_t smoothing = 0;  ///< group; 0 is off
};

/// Smoothing of a file without `s` statements: across edges that bend by less than 50°.
inline constexpr std::uint32_t smooth_by_angle = 0xffffffffu;

/// The normals that the file does not give, for each corner of each chunk; empty where a chunk has them all.
///
/// A corner's normal is the sum of the unit normals of the faces about its place that are smooth with its own, each
/// times the face's angle there (vertices at exactly one place are one, as where patches of a surface meet): those of
/// its smoothing group, or those that bend away from it by less than 50°; with smoothing off its own face's alone. A
/// face without area has the normal +Y.
///
/// Edges     a corner with a normal in the file keeps it (its entry is zero); where more than 256 faces meet,
///           smoothing by angle takes all of them.
/// Exact     the same bits for any number of threads: sums are in the order of the file.
std::vector<std::vector<float3>> missing_normals(const ObjFile& file, const std::vector<ObjRun>& runs,
                                                 ImportBudget& budget);

/// Whether the file gives this corner a normal that has a direction.
inline bool has_normal(const ObjFile& file, const ObjCorner& corner) {
  return corner.normal >= 0 && file.normals[static_cast<std::size_t>(corner.normal)] != float3{0, 0, 0};
}

}  // namespace zoneplate
