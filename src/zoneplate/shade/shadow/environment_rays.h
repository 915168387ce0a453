// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "zoneplate/math/vec.h"
#include "zoneplate/shade/environment/environment_view.h"
#include "zoneplate/shade/shadow/hemisphere_light.h"

namespace zoneplate {

/// Directions from which an environment's light arrives at surfaces, each with the same part of the irradiance.
///
/// The hemisphere above a surface is a disc whose areas are proportional to solid angle times the cosine with the
/// normal. It is divided into rings of equal area and these into sectors, each with the light of its middle, blurred to
/// about a cell's width. A spiral of equal areas is warped such that its density is proportional to that light: first
/// across the rings, then along each ring. Under light from all sides alike it stays as it is.
///
/// Exact     the same bits for any number of threads and any instruction set.
/// Source    the octahedron: Praun and Hoppe, Spherical Parametrization and Remeshing, SIGGRAPH 2003; importance sampling
///           by marginal and conditional distributions: Pharr, Jakob and Humphreys, Physically Based Rendering, 4th
///           edition, A.5.
class EnvironmentRays {
 public:
  explicit EnvironmentRays(const EnvironmentView& environment);

  /// Whether the light of all directions is the same.
  bool is_uniform() const { return is_uniform_; }

  /// The directions above one surface.
  class Hemisphere {
   public:
    using Directions = float[3][HemispherePlaces::capacity];

    /// Requires  the normal has unit length.
    Hemisphere(const EnvironmentRays& rays, float3 normal);

    bool is_about(float3 normal) const { return frame_[2] == normal; }
    /// Whether light arrives at all.
    bool is_lit() const { return all_ > 0; }
    /// Begins the `count` directions of a receiver.
    void begin(std::uint32_t seed, int count);
    /// The next ones of the directions, of unit length. Requires: light arrives, they have begun, and their number
    /// is at most HemispherePlaces::capacity.
    void next(int number, Directions& directions);

   private:
    const HemisphereKernels& kernels_;
    float3 frame_[3];
    HemisphereLight light_;
    float all_ = 0, step_ = 0, target_ = 0;  ///< the sum of all rings, and of it
    float before_ = 0;                       ///< the sum of the rings before the current one
    std::uint32_t turn_ = 0;                 ///< in units of 2^-32 of a whole one
    int ring_ = 0;
  };

 private:
  static constexpr int side = HemisphereKernels::side;

  std::array<float, std::size_t{side} * side> light_;    ///< luminance
  alignas(64) float middle_[3][HemisphereCells::count];  ///< directions about +z, of unit length
  bool is_uniform_ = true;
  const HemisphereKernels& kernels_;
};

}  // namespace zoneplate
