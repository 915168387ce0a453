// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/smaa/edge_detection.h"

#include "zoneplate/antialias/post/smaa/edge_detection_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const SmaaKernels PerIsa<SmaaKernels>::scalar = stages::smaa_edge_detection<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
