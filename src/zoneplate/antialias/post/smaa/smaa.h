#pragma once

#include <array>
#include <memory>

#include "zoneplate/antialias/post/edge_rows.h"
#include "zoneplate/antialias/post/weight_rows.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct SmaaOptions {
  enum class Edges { Luma, Color, Depth };

  Edges edges = Edges::Luma;
  double threshold = 0.1;               ///< least difference of codes / 255 that is an edge; a tenth of it for depth
  bool is_predicated = false;           ///< thresholds depend on a predication buffer; not for Edges::Depth
  double predication_threshold = 0.01;  ///< least difference of the predication buffer that crosses a border
  double predication_scale = 2;         ///< of the threshold of borders that are not crossed
  double predication_strength = 0.4;    ///< the share by which it is lower at those that are
  int steps = 16;                       ///< of two pixels, along an edge; at most 112
  int diagonal_steps = 8;               ///< of one pixel, along a diagonal; 0: none; at most 20
  int corner_rounding = 25;             ///< percent; 100: corners are not looked for
  std::array<int, 4> slots = {};        ///< of the areas for left edges, top edges and the two diagonals
  bool mixes_light = true;              ///< mix linear light; else codes
  bool is_postprocessing = false;       ///< for tests: the rounded areas and signed corner distances of another program
};

// The three passes, by the names of the paper and its code:
//
//   picture, sRGB-encoded --+--> edge detection ------------------> edges: left, top of each pixel
//   depth, ids (optional) --'                                         |
//                                                                      v
//   areas under lines (tables.h), search steps ---> blending weight calculation, row by row
//                                                                      |
//                                                                      v  weights: shares of the four neighbours
//   picture, sRGB-encoded ------------------------> neighborhood blending ---> picture, sRGB-encoded
//                                                   (decodes the pixels that it mixes, mixes linear light, encodes)
//
// Luma and colour differences are those of sRGB-encoded values: a threshold is then about as visible in the dark as in
// the light. Only the last pass needs linear light.

/// Edge detection, on the sRGB-encoded picture or (Edges::Depth) on depth in [0, 1]. `depth` is the predication buffer
/// where `is_predicated` is set, of any unit; a difference that is not a number (of two infinities) crosses nothing.
EdgePlane smaa_edge_detection(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options);

struct SmaaTables;

/// Blending weight calculation, row by row. The edges and options outlive it.
class SmaaBlendingWeights {
 public:
  SmaaBlendingWeights(const EdgePlane& edges, const SmaaOptions& options);
  ~SmaaBlendingWeights();

  /// Puts the weights of row y into a cleared row.
  void find(int y, WeightRow& out) const;

 private:
  const EdgePlane& edges_;
  const SmaaOptions& options_;
  std::unique_ptr<const SmaaTables> tables_;
};

/// Neighborhood blending; `memory` as for apply_smaa.
Rgba8Image smaa_neighborhood_blending(const Rgba8Image& image, const SmaaBlendingWeights& weights,
                                      const SmaaOptions& options, Rgba8Image memory);

/// SMAA 1x; `memory` may be any picture, whose storage is reused where its size fits.
///
/// Requires  `depth` for Edges::Depth and, as the predication buffer, for `is_predicated`.
/// Edges     beyond the sides the outermost pixels go on.
/// Exact     what shaders fetch between pixels is read from its bits, so that all searches are exact.
/// Source    Jimenez, Echevarria, Sousa, Gutierrez, SMAA, Eurographics 2012; code v2.8.
Rgba8Image apply_smaa(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options,
                      Rgba8Image memory = {});

/// How far away a pixel can be that decides another one.
int smaa_reach(const SmaaOptions& options);

}  // namespace zoneplate::antialias
