// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "zoneplate/formats/obj/parse.h"

namespace zoneplate {

/// A range of elements of one chunk that have the same state.
struct ObjRun {
  std::uint32_t chunk = 0, begin = 0, end = 0;  ///< [begin, end) within the chunk
  int object = 0, material = 0;
  std::uint32_t smoothing = 0;  ///< smoothing group; 0 is off
};

/// The smoothing of a file without `s` statements: across edges that bend by less than 50°.
inline constexpr std::uint32_t smooth_by_angle = 0xffffffffu;

/// The contribution of a face's corner to the normals of all corners at its place.
struct ObjNormalShare {
  float3 normal;  ///< of its face
  float angle = 0;
  std::uint32_t smoothing = 0;
};

/// Writes the shares of the corners of a face.
void make_shares(std::span<const float3> polygon, std::uint32_t smoothing, std::span<ObjNormalShare> out);

/// Sums by smoothing group of the shares at a place where too many faces meet to compare all pairs; empty for others.
using ObjCrowd = std::map<std::uint32_t, float3>;
ObjCrowd sum_crowd(std::span<const ObjNormalShare> at_place);

/// The normal of a corner, whose share is `at_place[own]`, by all shares at its place, in the order of the file.
float3 smooth_normal(std::span<const ObjNormalShare> at_place, std::size_t own, const ObjCrowd& crowd);

/// Computes the normals that the file lacks, for each corner of each chunk; empty for chunks that have all normals.
///
/// The normal of a corner is a sum of unit normals of the faces that meet at its place, each weighted by the face's
/// angle there; vertices with exactly equal positions are one place, as where patches of a surface meet. The sum
/// includes the faces of the corner's smoothing group or, without groups, those whose normals deviate by less than 50°;
/// with smoothing off, only the corner's own face. A face without area has the normal +Y.
///
/// Edges     a corner with a normal in the file keeps it (its entry here is zero); where more than 256 faces meet,
///           smoothing by angle includes all of them.
/// Exact     the same bits for any number of threads: sums are in the order of the file.
std::vector<std::vector<float3>> missing_normals(const ObjFile& file, const std::vector<ObjRun>& runs,
                                                 ImportBudget& budget);

/// Whether the file has a normal of non-zero length for this corner.
inline bool has_normal(const ObjFile& file, const ObjCorner& corner) {
  return corner.normal >= 0 && file.normals[static_cast<std::size_t>(corner.normal)] != float3{0, 0, 0};
}

}  // namespace zoneplate
