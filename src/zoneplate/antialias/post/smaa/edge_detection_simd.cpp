// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/smaa/edge_detection.h"

#include "zoneplate/antialias/post/smaa/edge_detection_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {

template <>
const SmaaKernels PerIsa<SmaaKernels>::HWY_NAMESPACE =
    stages::smaa_edge_detection<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();

}  // namespace zoneplate
