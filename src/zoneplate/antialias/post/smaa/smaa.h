// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "zoneplate/antialias/post/edge_rows.h"
#include "zoneplate/antialias/post/weight_rows.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

struct SmaaOptions {
  enum class Edges { Luma, Color, Depth };

  Edges edges = Edges::Luma;
  double threshold = 0.1;      ///< minimum difference of encoded values / 255 at an edge; a tenth of it for depth
  bool is_predicated = false;  ///< thresholds depend on a predication buffer; not for Edges::Depth
  double predication_threshold = 0.01;  ///< minimum difference of the predication buffer across a border
  double predication_scale = 2;         ///< factor of the threshold at borders without that difference
  double predication_strength = 0.4;    ///< fraction by which the threshold is lowered at borders with it
  int steps = 16;                       ///< search steps of two pixels along an edge; at most 112
  int diagonal_steps = 8;               ///< search steps of one pixel along a diagonal; 0: none; at most 20
  int corner_rounding = 25;             ///< percent; 100: corners are not detected
  std::array<int, 4> slots = {};        ///< area tables for left edges, top edges and the two diagonals
  /// Areas in closed form for samples at this offset from the pixel's centre, in pixels; none: those of the tables.
  std::optional<float2> exact_offset = {};
  bool mixes_light = true;         ///< blend linear light, otherwise encoded values
  bool is_postprocessing = false;  ///< for tests: the rounded areas and signed corner distances of another program
};

// The three passes, with the names of the paper and its code:
//
//   image, sRGB-encoded --+--> edge detection ------------------> edges: left, top of each pixel
//   depth, ids (optional) --'                                         |
//                                                                      v
//   areas under lines (tables.h), search steps ---> blending weight calculation, row by row
//                                                                      |
//                                                                      v  weights of the four neighbours
//   image, sRGB-encoded ------------------------> neighborhood blending ---> image, sRGB-encoded
//                                                   (decodes the pixels that it blends, blends linear light, encodes)
//
// Luma and colour differences are computed on sRGB-encoded values: the visibility of a threshold is then about equal in
// dark and bright regions. Only the last pass needs linear light.

/// Edge detection, on the sRGB-encoded image or (Edges::Depth) on depth in [0, 1]. `depth` is the predication buffer,
/// of any unit, if `is_predicated` is set; a difference that is NaN (of two infinities) is below any threshold.
EdgePlane smaa_edge_detection(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options);

/// The offset of a sample from the pixel's centre, for SmaaOptions::exact_offset.
inline float2 offset_from_centre(SamplePosition sample) {
  return {static_cast<float>(sample.x) / 256 - 0.5f, static_cast<float>(sample.y) / 256 - 0.5f};
}

struct SmaaTables;

/// Blending weight calculation, row by row. The edges and options must outlive this object.
class SmaaBlendingWeights {
 public:
  SmaaBlendingWeights(const EdgePlane& edges, const SmaaOptions& options);
  ~SmaaBlendingWeights();

  /// Stores the weights of row y in a cleared row.
  void find(int y, WeightRow& out) const;

 private:
  const EdgePlane& edges_;
  const SmaaOptions& options_;
  std::unique_ptr<const SmaaTables> tables_;
};

/// Neighborhood blending; `memory` as for apply_smaa.
Rgba8Image smaa_neighborhood_blending(const Rgba8Image& image, const SmaaBlendingWeights& weights,
                                      const SmaaOptions& options, Rgba8Image memory);

/// SMAA 1x; `memory` may be any image, whose storage is reused if it has the same size.
///
/// Requires  `depth` for Edges::Depth and, as the predication buffer, for `is_predicated`.
/// Edges     the outermost pixels are repeated beyond the sides.
/// Exact     bits are read where shaders decode bilinear fetches, so that all searches are exact.
/// Source    Jimenez, Echevarria, Sousa, Gutierrez, SMAA, Eurographics 2012; code v2.8.
Rgba8Image apply_smaa(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options,
                      Rgba8Image memory = {});

/// The greatest distance between a pixel and one that it affects.
int smaa_radius(const SmaaOptions& options);

/// Where SMAA's areas come from.
enum class SmaaAreas {
  Tables,  ///< the area tables of the reference
  Exact,   ///< closed forms for the position of the sample (exact_areas.h)
};

/// SMAA with one of its modes, by the parameters of `smaa`; `method` is the name of the method in messages.
///
/// Errors    ErrorKind::Usage for predication with other modes, or its parameters without it.
std::unique_ptr<Resolver> make_smaa(const Settings& settings, SmaaAreas areas, const std::string& method);

}  // namespace zoneplate::antialias
