// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/mlaa/edge_detection.h"

#include <cstdlib>

#include "zoneplate/antialias/post/mlaa/edge_detection_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {
namespace scalar {
namespace {

bool differ(const std::uint8_t* a, const std::uint8_t* b, int least) {
  return std::abs(a[0] - b[0]) >= least || std::abs(a[1] - b[1]) >= least || std::abs(a[2] - b[2]) >= least;
}

void edges_row(const std::uint8_t* above, const std::uint8_t* here, int least, std::uint8_t* edges, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_left = i > 0 && differ(here + 4 * i, here + 4 * i - 4, least);
    edges[i] = static_cast<std::uint8_t>(is_left | differ(here + 4 * i, above + 4 * i, least) << 1);
  }
}

}  // namespace

}  // namespace scalar

template <>
const MlaaKernels PerIsa<MlaaKernels>::scalar = {.luma_edges = stages::mlaa_luma_edges<scalar::Float, scalar::OneFloat>,
                                                 .edges_row = scalar::edges_row};

}  // namespace zoneplate
