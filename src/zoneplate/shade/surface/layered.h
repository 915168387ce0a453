// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/raster/types/batch.h"
#include "zoneplate/shade/surface/shading_state.h"

namespace zoneplate {

/// The parameters of the layers at a batch's fragments, factors times textures. Those of layers that a material lacks
/// are unset.
struct LayerState {
  using Array = ShadingState::Array;
  alignas(64) Array specular, specular_color[3];
  alignas(64) Array clearcoat, clearcoat_roughness, clearcoat_normal[3];
  alignas(64) Array sheen_color[3], sheen_roughness;
  alignas(64) Array anisotropy, stretch[2];  ///< the direction in tangent space, of unit length
  alignas(64) Array iridescence, film_thickness;
  alignas(64) Array transmission, thickness;  ///< the latter in world space
  alignas(64) Array diffuse_transmission, diffuse_transmission_color[3];
};

/// The layers of a material, and the constants of those that it has.
struct LayeredUniforms {
  bool has_clearcoat = false, has_sheen = false, has_anisotropy = false, has_iridescence = false;
  bool has_transmission = false, has_diffuse_transmission = false;
  bool has_grey_interface = false;  ///< the dielectric interface reflects all channels alike
  bool has_volume = false;          ///< light passes through a medium below the surface, not through a thin wall
  float f0_of_ior = 0.04f;
  float ior = 1.5f;  ///< of refraction; infinite ones are large
  float iridescence_ior = 1.3f;
  float turn[2] = {1, 0};           ///< cosine and sine of the anisotropy's rotation
  float wall_roughness = 1;         ///< multiplies the roughness of transmitted light
  float absorption[3] = {0, 0, 0};  ///< coefficients of the medium, per metre
  float half_spread = 0;            ///< of the indices of refraction of red and blue about `ior`
};

}  // namespace zoneplate
