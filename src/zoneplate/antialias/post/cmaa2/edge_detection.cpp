// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/cmaa2/edge_detection.h"

#include <algorithm>

#include "zoneplate/antialias/post/cmaa2/edge_detection_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {
namespace scalar {
namespace {

void shape_row(const std::uint8_t* edges, const std::uint8_t* above, std::uint8_t* shapes, std::uint8_t* bits,
               std::size_t n) {
  std::fill_n(bits, (n + 7) / 8, std::uint8_t{0});
  for (std::size_t i = 0; i < n; ++i) {
    const int shape = edges[i] | (*(edges + i - 1) & 1) << 2 | (above[i] & 2) << 2;
    const bool has_corner = (shape & 5) != 0 && (shape & 10) != 0;
    shapes[i] = static_cast<std::uint8_t>(shape);
    bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | has_corner << i % 8);
  }
}

}  // namespace

}  // namespace scalar

template <>
const Cmaa2Kernels PerIsa<Cmaa2Kernels>::scalar = {.edge_row = stages::cmaa2_edge_row<scalar::Float, scalar::OneFloat>,
                                                   .shape_row = scalar::shape_row};

}  // namespace zoneplate
