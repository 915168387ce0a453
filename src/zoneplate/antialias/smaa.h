#pragma once

#include <array>

#include "zoneplate/antialias/edge_rows.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct SmaaOptions {
  enum class Edges { Luma, Color, Depth };

  Edges edges = Edges::Luma;
  double threshold = 0.1;          ///< least difference of codes / 255 that is an edge; a tenth of it for depth
  int steps = 16;                  ///< of two pixels, along an edge; at most 112
  int diagonal_steps = 8;          ///< of one pixel, along a diagonal; 0: none; at most 20
  int corner_rounding = 25;        ///< percent; 100: corners are not looked for
  std::array<int, 4> slots = {};   ///< of the areas for left edges, top edges and the two diagonals
  bool mixes_light = true;         ///< mix linear light; else codes
  bool is_postprocessing = false;  ///< for tests: the rounded areas and signed corner distances of another program
  Isa isa = best_isa();
};

/// What a pixel takes from across its borders, in 1/255.
struct SmaaWeights {
  std::uint8_t from_above = 0;  ///< this pixel, from the one above
  std::uint8_t to_above = 0;    ///< the pixel above, from this one
  std::uint8_t from_left = 0, to_left = 0;
};
using WeightPlane = Bordered<SmaaWeights>;

/// The first pass, on codes or (Edges::Depth) on depth in [0, 1].
EdgePlane smaa_edges(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options);

/// The second pass.
WeightPlane smaa_weights(const EdgePlane& edges, const SmaaOptions& options);

/// SMAA 1x; `memory` may be any picture, whose storage is reused where its size fits.
///
/// Requires  `depth` for Edges::Depth.
/// Edges     beyond the sides the outermost pixels go on.
/// Exact     what shaders fetch between pixels is read from its bits, so that all searches are exact.
/// Source    Jimenez, Echevarria, Sousa, Gutierrez, SMAA, Eurographics 2012; code v2.8.
Rgba8Image apply_smaa(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options,
                      Rgba8Image memory = {});

/// How far away a pixel can be that decides another one.
int smaa_reach(const SmaaOptions& options);

}  // namespace zoneplate::antialias
