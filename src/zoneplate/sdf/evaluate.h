// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/sdf/program.h"

namespace zoneplate::sdf {

/// The points of one evaluation: 8 × 8 pixels, or any others that are close together.
inline constexpr int batch_size = 64;

struct PointBatch {
  alignas(32) float x[batch_size], y[batch_size];
};

/// Distances, and their gradients: of length 1, or less within a smooth joint.
struct DistanceBatch {
  alignas(32) float d[batch_size], x[batch_size], y[batch_size];
};

/// The parts of an outline that determine the distances and the winding numbers of a batch.
struct PieceSelection {
  std::vector<std::int32_t> near;    ///< may be nearest to a point, or have a point in their bounds
  std::vector<std::int32_t> beside;  ///< others, to the right of a point at its height
  float winding = 0;                 ///< of other parts, which are right of all points and span their heights
};

/// Selects the parts for points in the rectangle [low_x, high_x] × [low_y, high_y].
void select_pieces(const Program& program, const Instruction& region, float low_x, float high_x, float low_y,
                   float high_y, PieceSelection& selection);

/// The stacks of an evaluation; one for each thread.
struct EvaluationStacks {
  explicit EvaluationStacks(const Program& program)
      : values(static_cast<std::size_t>(program.value_depth())),
        frames(static_cast<std::size_t>(program.frame_depth())) {}
  std::vector<DistanceBatch> values;
  std::vector<PointBatch> frames;
  PieceSelection selection;
};

/// One layer of a drawing over one block: its values in pixels, and where they are accumulated.
struct CoverageKernels : PerIsa<CoverageKernels> {
  /// The distances of a shape at 64 points, in values[0] of the stacks.
  ///
  /// Exact     within a few units in the last place of the coordinates relative to the shape's centre.
  void (*evaluate)(const Program& program, const ShapeCode& shape, const PointBatch& points, EvaluationStacks& stacks);
  /// Adds weight × the coverage of each pixel: the area, within a square of side `footprint` around each point, of the
  /// half-plane that has the point's distance and gradient.
  ///
  /// Exact     within 2e-7 of the area where the boundary is straight.
  /// Source    area sampling: Catmull, A Hidden-Surface Algorithm with Anti-Aliasing, SIGGRAPH 1978.
  void (*add_coverage)(const DistanceBatch& values, float inverse_footprint, float weight, float* coverage);
  /// Composites a premultiplied colour over 64 pixels: planes[c] = color[c] k + planes[c] (1 - color[3] k), with the
  /// coverage k.
  void (*composite)(const float* coverage, const float color[4], float* const planes[4]);
};

}  // namespace zoneplate::sdf
