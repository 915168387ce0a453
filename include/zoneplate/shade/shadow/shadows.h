// SPDX-License-Identifier: Apache-2.0
#pragma once

#pragma GCC visibility push(default)
namespace zoneplate {

/// How the shadows of lights are computed.
enum class ShadowMethod {
  None,  ///< every light reaches every surface
  Map,   ///< depth images from the lights: fast, with aliased edges
  Hard,  ///< one ray from each fragment to each light: the exact shadow of a point
  Soft,  ///< several rays from each fragment to each light, which has an extent
};

/// How the depths of a shadow map become the visibility of a light.
enum class ShadowFilter {
  Nearest,  ///< the texel that contains the point, compared with its depth
  Pcf,      ///< percentage closer filtering: the mean of comparisons within a radius
  Pcss,     ///< percentage closer soft shadows: PCF, whose radius is estimated from the distance of blockers
  Evsm,     ///< exponential variance shadow maps: a bound from filtered moments of warped depths
};

/// The maps of ShadowMethod::Map. They contain opaque and alpha-tested surfaces.
struct ShadowMapOptions {
  ShadowFilter filter = ShadowFilter::Pcf;  ///< percentage closer filtering by default
  int size = 2048;                          ///< texels a side; six such maps for a point light
  float radius = 1.5f;                      ///< of Pcf and Evsm, in texels
  float bias = 1;  ///< factor of the distance by which points are moved off their surface, against acne
};

/// The shadows that surfaces cast.
///
/// Both faces of every triangle cast shadows, whether or not back faces are drawn; lines and points cast none. An
/// alpha-tested surface casts its holes; a blended one attenuates light by its alpha.
struct ShadowOptions {
  ShadowMethod method = ShadowMethod::None;  ///< None by default
  int samples = 32;  ///< ShadowMethod::Soft: rays from a fragment to a light; best a power of two
  /// Soft and Pcss: the angular radius, in radians, of lights whose `radius` is 0. 3 degrees by default.
  float angle = 3 * (3.14159265f / 180);
  /// ShadowMethod::Soft: pixels between the points of a surface whose rays the fragments between them share where
  /// shadows are smooth; 1: every fragment has its own rays.
  int spacing = 1;
  ShadowMapOptions map{};  ///< ShadowMethod::Map
};

/// The part of the environment that nearby surfaces hide from a point; the environment's light is multiplied by the
/// rest.
struct OcclusionOptions {
  int samples = 0;     ///< rays from a fragment, cosine-weighted about the normal; 0: no occlusion
  float distance = 0;  ///< world units beyond which nothing occludes; 0: a quarter of the diagonal of the scene
  int spacing = 1;     ///< as ShadowOptions::spacing
};

/// What lies under the scene.
enum class GroundKind {
  None,    ///< nothing
  Shadow,  ///< a plane that is visible only where light is missing on it: a shadow on the background
};

}  // namespace zoneplate
#pragma GCC visibility pop
