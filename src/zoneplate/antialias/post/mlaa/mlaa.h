// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/smaa/smaa.h"

namespace zoneplate::antialias {

struct MlaaOptions {
  enum class Kind {
    Jimenez,   ///< for GPUs, 2011: searches of limited length, areas from a table
    Reshetov,  ///< the original, 2009: lines of any length, split where the colours of both sides meet
  };

  Kind kind = Kind::Jimenez;
  double threshold = 0.1;   ///< Jimenez: minimum difference of luma, as encoded value / 255
  int steps = 16;           ///< Jimenez: search steps of two pixels along an edge; 4, 8 or 16 in the original
  bool mixes_light = true;  ///< blend linear light, otherwise encoded values
};

/// Morphological antialiasing of an sRGB-encoded image; `memory` as for apply_smaa.
///
/// Edges     the outermost pixels are repeated beyond the sides (Jimenez); a line ends at the sides (Reshetov).
/// Source    Reshetov, Morphological Antialiasing, HPG 2009; Jimenez et al., Practical Morphological Anti-Aliasing, GPU
///           Pro 2, 2011.
Rgba8Image apply_mlaa(const Rgba8Image& image, const MlaaOptions& options, Rgba8Image memory = {});

/// The weights of all edges by Reshetov's method, which cannot be computed row by row.
using WeightPlane = Bordered<EdgeWeights>;
WeightPlane mlaa_reshetov_weights(const Rgba8Image& image);

/// The height in [0, 1] at which a line crosses the step between two columns such that the blended colours of both
/// sides are equal; ½ if there is none. `near` and `across` are lumas at the line's end, on this side of its border and
/// on the other; `beyond` and `beyond_near` are those of the next column, in the same row as `near` and one row farther
/// from the border.
float split_height(int near, int across, int beyond, int beyond_near);

}  // namespace zoneplate::antialias
