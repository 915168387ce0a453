// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/display_step.h"

#include "zoneplate/image/display_step_lanes.h"
#include "zoneplate/math/lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

/// Pairs of groups of eight pixels in vectors of sixteen lanes.
struct SixteenPixels {
  using Float = WideFloat;
  static constexpr bool exist = WideFloat::lanes == 16;
  static HWY_INLINE Float load(const float* low, const float* high) {
    const hn::CappedTag<float, 16> d;
    const hn::Half<decltype(d)> half;
    return Float(combined(d, hn::LoadU(half, high), hn::LoadU(half, low)));
  }
};

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const TonemapKernels PerIsa<TonemapKernels>::HWY_NAMESPACE =
    stages::display_step<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat, HWY_NAMESPACE::SixteenPixels>();
}  // namespace zoneplate
