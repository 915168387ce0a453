// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/sdf/program.h"

namespace zoneplate::sdf {

/// The points of one evaluation: 8 × 8 pixels, or any others that are close together.
inline constexpr int batch_size = 64;

struct PointBatch {
  int begin = 0, end = batch_size;  ///< the points to be evaluated: multiples of 8
  alignas(32) float x[batch_size], y[batch_size];
};

/// Distances, and their gradients: of length 1, or less within a smooth joint.
struct DistanceBatch {
  alignas(32) float d[batch_size], x[batch_size], y[batch_size];
};

/// A rectangle of an outline's coordinates.
struct LocalRectangle {
  float low_x = 0, high_x = 0, low_y = 0, high_y = 0;
};

/// The parts of an outline that determine the distances and the winding numbers of points in a rectangle.
struct PieceSelection {
  std::vector<std::int32_t> near;    ///< may be nearest to a point, or pass between points
  std::vector<std::int32_t> beside;  ///< others, to the right of all points at their heights
  float winding = 0;                 ///< of other parts, which are right of all points and span their heights
  std::vector<float> distances;      ///< from the middle of the rectangle, while parts are selected
};

/// Selects from all parts.
void select_pieces(const Program& program, const Instruction& region, const LocalRectangle& points,
                   PieceSelection& selection);
/// Selects from the parts for a rectangle around that of the points.
void select_pieces(const Program& program, const PieceSelection& around, const LocalRectangle& points,
                   PieceSelection& selection);

/// The stacks of an evaluation; one for each thread.
struct EvaluationStacks {
  explicit EvaluationStacks(const Program& program)
      : values(static_cast<std::size_t>(program.value_depth())),
        kept(static_cast<std::size_t>(program.slots())),
        frames(static_cast<std::size_t>(program.frame_depth())) {}
  std::vector<DistanceBatch> values, kept;
  std::vector<PointBatch> frames;
  PieceSelection selection;

  /// The parts of an outline of many parts that matter to the points of the next evaluations.
  struct RegionSelection {
    std::size_t instruction;
    PieceSelection pieces;
  };
  std::vector<RegionSelection> regions{};  ///< in the order of instructions

  /// Selects parts for evaluations of this shape at points within the bounds.
  void select_for(const Program& program, const ShapeCode& shape, const Bounds& points);
};

/// One layer of a drawing over one block: its values in pixels, and where they are accumulated.
struct CoverageKernels : PerIsa<CoverageKernels> {
  /// The distances of a shape at the points, in values[0] of the stacks.
  ///
  /// Exact     within a few units in the last place of the coordinates relative to the shape's centre.
  void (*evaluate)(const Program& program, const ShapeCode& shape, const PointBatch& points, EvaluationStacks& stacks);
  /// Adds weight × the coverage of each pixel: the area, within a square of side `footprint` around each point, of the
  /// half-plane that has the point's distance and gradient.
  ///
  /// Exact     within 2e-7 of the area where the boundary is straight.
  /// Source    area sampling: Catmull, A Hidden-Surface Algorithm with Anti-Aliasing, SIGGRAPH 1978.
  void (*add_coverage)(const PointBatch& points, const DistanceBatch& values, float inverse_footprint, float weight,
                       float* coverage);
  /// Composites a premultiplied colour over the pixels of the points: planes[c] = color[c] k + planes[c] (1 - color[3]
  /// k), with the coverage k.
  void (*composite)(const PointBatch& points, const float* coverage, const float color[4], float* const planes[4]);
};

}  // namespace zoneplate::sdf
