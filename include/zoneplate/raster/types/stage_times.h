// SPDX-License-Identifier: Apache-2.0
#pragma once

#pragma GCC visibility push(default)
namespace zoneplate {

/// The time of a frame by stage, in milliseconds.
///
/// `vertices` and `triangles` are wall-clock times. The other stages run tile by tile on all threads at once; their
/// times are sums over the threads, including the time spent waiting for a processor.
struct StageTimes {
  double vertices = 0;    ///< transform, divide, snap
  double triangles = 0;   ///< cull, clip, set up, and sort into tiles
  double visibility = 0;  ///< depth and owner of each sample
  double shading = 0;     ///< interpolation, textures, lighting, and the resolve of spans
  double blending = 0;    ///< transparent layers: sorting, shading, compositing
  double output = 0;      ///< the resolve of other pixels, tone mapping, encoding

  /// Adds the times stage by stage.
  StageTimes& operator+=(const StageTimes& o) {
    vertices += o.vertices, triangles += o.triangles, visibility += o.visibility;
    shading += o.shading, blending += o.blending, output += o.output;
    return *this;
  }
};

}  // namespace zoneplate
#pragma GCC visibility pop
