// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The error of an image at the straight edges of its reference, by the angle between edge and nearer axis.
struct EdgeError {
  static constexpr int bins = 9;  ///< of 5° each, from level and upright edges to the diagonal
  struct Bin {
    std::uint64_t pixels = 0;
    double squares = 0;  ///< sum of squared differences of luma
  };
  std::array<Bin, bins> by_angle;

  /// Root mean square over the bins [first, last); nothing where they hold no pixel.
  std::optional<double> rms(int first = 0, int last = bins) const;
};

/// A pixel is of an edge where the reference's luma changes by 0.04 a pixel or more, and changes one way all around:
/// the greater eigenvalue of its structure tensor (5 × 5 pixels, binomial weights) is 9 times the lesser.
///
/// Requires  equal sizes.
/// Units     luma of sRGB codes, in [0, 1].
/// Edges     the two outermost pixels do not count.
/// Exact     a straight edge with box-filtered pixels falls into its bin or the next one; the same bits everywhere.
/// Source    structure tensor: Förstner and Gülch, A Fast Operator for Detection and Precise Location of Distinct
///           Points, Corners and Centres of Circular Features, ISPRS 1987.
EdgeError measure_edge_error(const DisplayImage& reference, const DisplayImage& test);

}  // namespace zoneplate::metrics
