// SPDX-License-Identifier: Apache-2.0
#pragma once

#pragma GCC visibility push(default)
namespace zoneplate {

/// At which of the samples that a triangle covers an alpha-tested surface is present.
enum class AlphaTest {
  Pixel,     ///< at all or none, by the alpha of the fragment
  Samples,   ///< by the alpha at each sample
  Coverage,  ///< at a number of samples in proportion to alpha (alpha to coverage)
  Sharp,     ///< alpha to coverage of alpha sharpened to an edge one pixel wide
};

/// Where in a pixel a surface is shaded that owns a part of its samples. A surface that owns all of them is shaded at
/// the pixel's centre, unless the rule says otherwise.
enum class Centroid {
  Mean,       ///< at the mean of the samples that it owns
  First,      ///< at the first of them
  Centre,     ///< at the pixel's centre, even if it lies outside the triangle: the weights are clamped
  MeanOfAll,  ///< as Mean, also where it owns all samples: for patterns whose mean is not the pixel's centre
};

/// How often lights and materials are evaluated.
enum class ShadingFrequency {
  Triangle,  ///< once for a triangle, at its middle, with the normal of its plane (flat shading)
  Vertex,    ///< at the vertices, and interpolated over the triangle (Gouraud shading)
  Fragment,  ///< at every fragment, with the interpolated normal (Phong shading)
};

}  // namespace zoneplate
#pragma GCC visibility pop
