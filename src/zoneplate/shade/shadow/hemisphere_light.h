// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A table over directions about +z: by sector, then by ring of the disc that the hemisphere is.
struct HemisphereCells {
  static constexpr int rings = 16, sectors = 32, count = rings * sectors;
};

/// The light from the directions above a surface.
struct HemisphereLight {
  alignas(64) std::int32_t light[HemisphereCells::count];  ///< bits of floats
  alignas(64) float sum[HemisphereCells::rings];           ///< of a ring's sectors
};

/// Where directions lie by the light of rings before theirs, and by the light along their ring.
struct HemispherePlaces {
  static constexpr int capacity = 64;
  int count = 0;
  alignas(64) std::int32_t ring[capacity];
  alignas(64) float across[capacity];  ///< less than the ring's sum
  alignas(64) float turn[capacity];    ///< in [0, 1), of the ring's sum
};

/// What environment_rays.h computes for a surface and for its receivers. `frame`: two unit vectors across a normal, and
/// the normal.
struct HemisphereKernels : PerIsa<HemisphereKernels> {
  static constexpr int side = 32;  ///< cells along the square of the octahedron

  /// `middle`: of the cells, unit vectors about +z. `octahedron`: the light of side × side cells.
  void (*look_up)(const float* octahedron, const float (&middle)[3][HemisphereCells::count], const float3 (&frame)[3],
                  HemisphereLight& out);
  /// Stores unit vectors.
  void (*directions)(const HemisphereLight& light, const HemispherePlaces& places, const float3 (&frame)[3],
                     float (&direction)[3][HemispherePlaces::capacity]);
};

}  // namespace zoneplate
