#pragma once

namespace zoneplate {

/// Where a masked surface is there, at the samples that a triangle covers.
enum class AlphaTest {
  Pixel,     ///< at all or none of them: alpha at the point that is shaded
  Samples,   ///< alpha at each sample by itself
  Coverage,  ///< at as many as alpha says
  Sharp,     ///< the same of alpha made steep about the cutoff: its edge is a pixel wide
};

/// Where in a pixel a surface is shaded that owns some of its samples. One that owns them all is shaded at the centre.
enum class Centroid {
  Mean,    ///< at the mean of the samples that it owns
  First,   ///< at the first of them
  Centre,  ///< at the pixel's centre, where the surface may not even be: its weights are held to the triangle
};

}  // namespace zoneplate
