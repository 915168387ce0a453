// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// Which edges of triangle meshes are drawn as lines.
enum class EdgeKind {
  None,      ///< none
  Features,  ///< boundaries, creases and silhouettes
  Mesh,      ///< all edges of all triangles
};

/// Lines along the edges of meshes, drawn over the finished image.
struct EdgeOptions {
  EdgeKind kind = EdgeKind::None;   ///< which edges are drawn
  float crease_angle = 0.5235988f;  ///< radians (30°); an edge is a crease where its two normals differ by more
  float width = 1;                  ///< pixels of the image
  std::optional<float4> color{};    ///< sRGB code, straight alpha; none: black, or white on a dark background alone
  bool hides = true;                ///< surfaces hide the lines behind them
  bool has_surfaces = true;         ///< surfaces are drawn; otherwise the lines lie over the background alone
};

}  // namespace zoneplate
#pragma GCC visibility pop
