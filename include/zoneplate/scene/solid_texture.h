// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The function that a solid texture evaluates.
enum class SolidPattern {
  None,        ///< no solid texture
  Noise,       ///< a fractal sum of Perlin noise
  Turbulence,  ///< a fractal sum of its absolute values, as of smoke and clouds
  Marble,      ///< veins across the x axis, distorted by turbulence
  Wood,        ///< annual rings about the y axis, distorted by noise, with a fine grain
  Rock,        ///< mottled noise with dark cracks
};

/// A procedural texture: a colour for every point of object space, so that a mesh needs no texture coordinates.
///
/// Every pattern is filtered analytically by the pixel's footprint: waves are attenuated by the box filter's response,
/// octaves of noise fade out before they alias, so that the texture tends to its mean colour with distance.
/// Units     lengths in the mesh's own units; colours linear, in [0, 1].
/// Source    Perlin, An Image Synthesizer, SIGGRAPH 1985, and Improving Noise, SIGGRAPH 2002; Peachey in Ebert et al.,
///           Texturing and Modeling, 3rd edition 2003, chapter 2.
struct SolidTexture {
  SolidPattern pattern = SolidPattern::None;  ///< None: the other members do not count
  float scale = 1;                            ///< lattice cells, veins or rings per unit of length
  int octaves = 5;                            ///< of fractal sums, 1 to 12
  float gain = 0.5f;                          ///< the amplitude of an octave relative to the octave before
  float distortion = 1;                       ///< of veins and rings, in their own distance
  bool is_filtered = true;                    ///< false, for teaching: point samples, which alias
  float3 low{0, 0, 0};                        ///< the colour where the pattern is 0
  float3 high{1, 1, 1};                       ///< the colour where the pattern is 1
  bool operator==(const SolidTexture&) const = default;
};

}  // namespace zoneplate
#pragma GCC visibility pop
