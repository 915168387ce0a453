// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "zoneplate/math/vec.h"
#include "zoneplate/shade/environment/environment_view.h"
#include "zoneplate/shade/shadow/disc_samples.h"

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
  static constexpr int rings = 16, sectors = 32;
  static constexpr std::size_t cells = std::size_t{rings} * sectors;

  explicit EnvironmentRays(const EnvironmentView& environment);

  /// Whether the light of all directions is the same.
  bool is_uniform() const { return is_uniform_; }

  /// The directions above one surface.
  class Hemisphere {
   public:
    /// Requires  the normal has unit length.
    Hemisphere(const EnvironmentRays& rays, float3 normal, int count);

    bool is_about(float3 normal) const { return directions_.axis() == normal; }
    /// Whether light arrives at all.
    bool is_lit() const { return step_ > 0; }
    /// Begins the directions of a receiver.
    void begin(std::uint32_t seed);
    /// The next of `count` directions, of unit length. Requires: light arrives, and they have begun.
    float3 next();

   private:
    DirectionsAbout directions_;
    std::array<float, cells> light_;
    std::array<float, rings> sum_;              ///< of a ring's sectors
    float step_ = 0, target_ = 0, before_ = 0;  ///< of the whole sum; the sum of the rings before the current one
    std::uint32_t turn_ = 0;                    ///< in units of 2^-32 of a whole one
    std::size_t ring_ = 0;
  };

 private:
  static constexpr int side = 32;  ///< cells along the square of the octahedron

  std::array<float, std::size_t{side} * side> light_;  ///< luminance
  std::array<std::array<float, cells>, 3> middle_;     ///< directions about +z, of unit length
  bool is_uniform_ = true;
};

}  // namespace zoneplate
