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
  /// Int::store_pixels of eight pixels each.
  static HWY_INLINE void store_pixels(Float::Int r, Float::Int g, Float::Int b, Float::Int a, Rgba8* low, Rgba8* high) {
    const hn::CappedTag<std::int32_t, 16> d;
    const hn::Half<decltype(d)> half;
    const auto pixels =
        hn::Or(hn::Or(r.v, hn::ShiftLeft<8>(g.v)), hn::Or(hn::ShiftLeft<16>(b.v), hn::ShiftLeft<24>(a.v)));
    hn::StoreU(hn::LowerHalf(half, pixels), half, reinterpret_cast<std::int32_t*>(low));
    hn::StoreU(hn::UpperHalf(half, pixels), half, reinterpret_cast<std::int32_t*>(high));
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
