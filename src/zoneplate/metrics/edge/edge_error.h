// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The error of an image at the straight edges of its reference, by the angle between edge and nearer axis.
struct EdgeError {
  static constexpr int bins = 9;  ///< of 5° each, from horizontal and vertical edges to diagonal ones
  struct Bin {
    std::uint64_t pixels = 0;
    double squares = 0;  ///< sum of squared differences of luma
  };
  std::array<Bin, bins> by_angle;

  /// Root mean square over the bins [first, last); nothing if they have no pixels.
  std::optional<double> rms(int first = 0, int last = bins) const;
};

/// Measures the error at edges. A pixel belongs to an edge if the reference's luma has a gradient of at least 0.04 per
/// pixel with one dominant direction: the greater eigenvalue of its structure tensor (5 × 5 pixels, binomial weights)
/// is 9 times the lesser.
///
/// Requires  equal sizes.
/// Units     luma of sRGB codes, in [0, 1].
/// Edges     the two outermost pixels are ignored, and those that the reference ignores.
/// Exact     a straight edge with box-filtered pixels is assigned to its bin or an adjacent one; the same bits
///           everywhere.
/// Source    structure tensor: Förstner and Gülch, A Fast Operator for Detection and Precise Location of Distinct
///           Points, Corners and Centres of Circular Features, ISPRS 1987.
EdgeError measure_edge_error(const Picture& reference, const Picture& test);

}  // namespace zoneplate::metrics
