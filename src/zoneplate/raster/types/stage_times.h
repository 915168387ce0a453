#pragma once

namespace zoneplate {

/// Where a frame's time went, in milliseconds.
///
/// Vertices and triangles are steps that follow each other, by the clock on the wall. The rest happens tile by tile,
/// on all threads at once: the sum of the threads' times, waiting for a processor included.
struct StageTimes {
  double vertices = 0;    ///< transform, divide, snap
  double triangles = 0;   ///< cull, clip, set up, and sort into tiles
  double visibility = 0;  ///< who owns each sample
  double shading = 0;     ///< interpolation, textures, light; and the mean of the samples of whole rows
  double blending = 0;    ///< layers: sorted, shaded, laid over each other
  double output = 0;      ///< the mean of the samples of other pixels, tone mapping, encoding, 8 bits

  StageTimes& operator+=(const StageTimes& o) {
    vertices += o.vertices, triangles += o.triangles, visibility += o.visibility;
    shading += o.shading, blending += o.blending, output += o.output;
    return *this;
  }
};

}  // namespace zoneplate
