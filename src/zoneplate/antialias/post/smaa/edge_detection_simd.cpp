#include <hwy/highway.h>

#include "zoneplate/antialias/post/edges_simd.h"
#include "zoneplate/antialias/post/smaa/edge_detection_lanes.h"
#include "zoneplate/math/lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// The thresholds of the left and top borders of some pixels.
template <class V>
struct Least {
  V left, top;
};
template <class D, class T>
HWY_INLINE Least<hn::Vec<D>> least_of(D d, T threshold, const std::uint8_t*) {
  return {hn::Set(d, threshold), hn::Set(d, threshold)};
}
/// `crossed`: what the edges hold before.
template <class D, class T>
HWY_INLINE Least<hn::Vec<D>> least_of(D d, const PredicatedThreshold<T>& threshold, const std::uint8_t* crossed) {
  const hn::RebindToUnsigned<D> du;
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto bits = hn::PromoteTo(du, hn::LoadU(bytes, crossed));
  const auto plain = hn::Set(d, threshold.plain), other = hn::Set(d, threshold.crossed);
  const auto left = hn::TestBit(bits, hn::Set(du, 1)), top = hn::TestBit(bits, hn::Set(du, 2));
  return {hn::IfThenElse(hn::RebindMask(d, left), other, plain), hn::IfThenElse(hn::RebindMask(d, top), other, plain)};
}

/// The greatest difference of the three colours of each pixel.
template <class D, class V>
HWY_INLINE V difference(D d, V a, V b) {
  const hn::Repartition<std::uint8_t, D> bytes;
  const auto x = hn::BitCast(bytes, a), y = hn::BitCast(bytes, b);
  const auto each = hn::BitCast(d, hn::Or(hn::SaturatedSub(x, y), hn::SaturatedSub(y, x)));
  const auto mask = hn::Set(d, 255u);
  const auto r = hn::And(each, mask), g = hn::And(hn::ShiftRight<8>(each), mask);
  return hn::Max(r, hn::Max(g, hn::And(hn::ShiftRight<16>(each), mask)));
}

template <class D, class Threshold>
HWY_INLINE void color_edges_some(D d, const EdgeRows<std::uint32_t>& rows, const Threshold& threshold,
                                 std::uint8_t* edges, std::size_t i) {
  const hn::RebindToSigned<D> di;
  const std::uint32_t *above2 = rows.row[0] + i, *above = rows.row[1] + i, *here = rows.row[2] + i;
  const auto m = hn::LoadU(d, here);
  const auto to = [&](const std::uint32_t* other)
                      HWY_ATTR { return hn::BitCast(di, difference(d, m, hn::LoadU(d, other))); };
  const auto least = least_of(d, threshold, edges + i);
  const auto below_left = hn::Sub(hn::BitCast(di, least.left), hn::Set(di, 1));
  const auto below_top = hn::Sub(hn::BitCast(di, least.top), hn::Set(di, 1));
  const auto to_left = to(here - 1), to_top = to(above), far_left = to(here - 2), far_top = to(above2);
  const auto to_right = to(here + 1), to_bottom = to(rows.row[3] + i);
  const auto near = hn::Max(hn::Max(to_left, to_top), hn::Max(to_right, to_bottom));
  const auto limit = hn::Sub(hn::Max(near, hn::Max(far_left, far_top)), hn::Set(di, 1));
  const auto left = hn::And(hn::Gt(to_left, below_left), hn::Gt(hn::Add(to_left, to_left), limit));
  const auto top = hn::And(hn::Gt(to_top, below_top), hn::Gt(hn::Add(to_top, to_top), limit));
  store_edges(d, hn::RebindMask(d, left), hn::RebindMask(d, top), edges + i);
}

template <class Threshold>
HWY_INLINE void find_color_edges(const EdgeRows<std::uint32_t>& rows, const Threshold& threshold, std::uint8_t* edges,
                                 std::size_t n) {
  for_lanes<std::uint32_t>(n, [&](auto d, std::size_t i) HWY_ATTR { color_edges_some(d, rows, threshold, edges, i); });
}

void color_edges(const EdgeRows<std::uint32_t>& rows, std::uint32_t threshold, std::uint8_t* edges, std::size_t n) {
  find_color_edges(rows, threshold, edges, n);
}

void predicated_color_edges(const EdgeRows<std::uint32_t>& rows, const PredicatedThreshold<std::uint32_t>& threshold,
                            std::uint8_t* edges, std::size_t n) {
  find_color_edges(rows, threshold, edges, n);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const SmaaKernels PerIsa<SmaaKernels>::HWY_NAMESPACE = {
    .luma_edges = stages::smaa_luma_edges<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>,
    .color_edges = HWY_NAMESPACE::color_edges,
    .predicated_luma_edges = stages::smaa_predicated_luma_edges<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>,
    .predicated_color_edges = HWY_NAMESPACE::predicated_color_edges};
}  // namespace zoneplate
