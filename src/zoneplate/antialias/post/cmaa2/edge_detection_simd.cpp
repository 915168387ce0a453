// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/antialias/post/cmaa2/edge_detection_lanes.h"
#include "zoneplate/math/lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void shape_row(const std::uint8_t* edges, const std::uint8_t* above, std::uint8_t* shapes, std::uint8_t* bits,
               std::size_t n) {
  const hn::CappedTag<std::uint8_t, 32> d;
  const hn::Repartition<std::uint16_t, decltype(d)> wide;
  const auto one = hn::Set(d, std::uint8_t{1}), two = hn::Set(d, std::uint8_t{2});
  const auto level = hn::Set(d, std::uint8_t{5}), upright = hn::Set(d, std::uint8_t{10});
  const auto zero = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    // The shifted bits never leave their bytes.
    const auto left = hn::And(hn::LoadU(d, edges + i - 1), one), top = hn::And(hn::LoadU(d, above + i), two);
    const auto moved = hn::BitCast(d, hn::ShiftLeft<2>(hn::BitCast(wide, hn::Or(left, top))));
    const auto shape = hn::Or(hn::LoadU(d, edges + i), moved);
    hn::StoreU(shape, d, shapes + i);
    const auto lacks = hn::Or(hn::Eq(hn::And(shape, level), zero), hn::Eq(hn::And(shape, upright), zero));
    hn::StoreMaskBits(d, hn::Not(lacks), bits + i / 8);
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const Cmaa2Kernels PerIsa<Cmaa2Kernels>::HWY_NAMESPACE = {
    .edge_row = stages::cmaa2_edge_row<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>,
    .shape_row = HWY_NAMESPACE::shape_row};
}  // namespace zoneplate
