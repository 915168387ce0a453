// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/antialias/post/mlaa/edge_detection_lanes.h"
#include "zoneplate/math/lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE hn::Vec<D> load_pixels(D d, const std::uint8_t* p) {
  const hn::Repartition<std::uint8_t, D> bytes;
  return hn::BitCast(d, hn::LoadU(bytes, p));
}

/// Whether the difference of any of the three channels has one of the bits of `mask`.
template <class D>
HWY_INLINE hn::Mask<D> differ(D d, hn::Vec<D> a, hn::Vec<D> b, hn::Vec<D> mask) {
  const hn::Repartition<std::uint8_t, D> bytes;
  const auto x = hn::BitCast(bytes, a), y = hn::BitCast(bytes, b);
  const auto difference = hn::BitCast(d, hn::Or(hn::SaturatedSub(x, y), hn::SaturatedSub(y, x)));
  return hn::Not(hn::Eq(hn::And(difference, mask), hn::Zero(d)));
}

/// Stores 1 if `left` plus 2 if `top`, one byte per lane.
template <class D, class M>
HWY_INLINE void store_edges(D d, M left, M top, std::uint8_t* edges) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto bits = hn::Or(hn::IfThenElseZero(left, hn::Set(d, 1)), hn::IfThenElseZero(top, hn::Set(d, 2)));
  hn::StoreU(hn::DemoteTo(bytes, bits), bytes, edges);
}

template <class D>
HWY_INLINE void edges_some(D d, const std::uint8_t* above, const std::uint8_t* here, hn::Vec<D> mask,
                           std::uint8_t* edges, std::size_t i) {
  const auto m = load_pixels(d, here + 4 * i);
  const auto left = differ(d, m, load_pixels(d, here + 4 * i - 4), mask);
  const auto top = differ(d, m, load_pixels(d, above + 4 * i), mask);
  store_edges(d, left, top, edges + i);
}

void edges_row(const std::uint8_t* above, const std::uint8_t* here, int least, std::uint8_t* edges, std::size_t n) {
  const hn::CappedTag<std::int32_t, 8> full;
  const hn::CappedTag<std::int32_t, 1> one;
  if (n == 0) return;
  const int bits = 256 - least, mask = bits | bits << 8 | bits << 16;
  const auto first = differ(one, load_pixels(one, here), load_pixels(one, above), hn::Set(one, mask));
  edges[0] = hn::AllFalse(one, first) ? 0 : 2;
  std::size_t i = 1;
  const std::size_t lanes = hn::Lanes(full);
  for (; i + lanes <= n; i += lanes) edges_some(full, above, here, hn::Set(full, mask), edges, i);
  for (; i < n; ++i) edges_some(one, above, here, hn::Set(one, mask), edges, i);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const MlaaKernels PerIsa<MlaaKernels>::HWY_NAMESPACE = {
    .luma_edges = stages::mlaa_luma_edges<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>,
    .edges_row = HWY_NAMESPACE::edges_row};
}  // namespace zoneplate
