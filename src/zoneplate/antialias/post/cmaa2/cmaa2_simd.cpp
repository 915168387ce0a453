#include <hwy/highway.h>

#include "zoneplate/antialias/post/cmaa2/cmaa2_kernels.h"
#include "zoneplate/math/for_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE void edge_some(D d, const float* const (&rows)[4], float threshold, float contrast, std::uint8_t* edges,
                          std::size_t i) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto at = [&](int row, int x) HWY_ATTR { return hn::LoadU(d, rows[row] + static_cast<std::ptrdiff_t>(i) + x); };
  const auto between = [&](hn::Vec<D> a, hn::Vec<D> b) HWY_ATTR { return hn::Abs(hn::Sub(a, b)); };
  const auto m = at(1, 0), e = at(1, 1), s = at(2, 0), se = at(2, 1), n = at(0, 0), ne = at(0, 1);
  const auto w = at(1, -1), sw = at(2, -1);
  const auto right = between(m, e), below = between(m, s);
  const auto ends_right = hn::Max(hn::Max(between(n, m), below), hn::Max(between(ne, e), between(e, se)));
  const auto ends_below = hn::Max(hn::Max(between(w, m), right), hn::Max(between(sw, s), between(s, se)));
  const auto least = hn::Set(d, threshold), share = hn::Set(d, contrast);
  const auto is_right = hn::Gt(hn::Sub(right, hn::Mul(share, ends_right)), least);
  const auto is_below = hn::Gt(hn::Sub(below, hn::Mul(share, ends_below)), least);
  const auto bits = hn::Or(hn::IfThenElseZero(hn::RebindMask(di, is_right), hn::Set(di, 1)),
                           hn::IfThenElseZero(hn::RebindMask(di, is_below), hn::Set(di, 2)));
  hn::StoreU(hn::DemoteTo(bytes, bits), bytes, edges + i);
}

void edge_row(const float* const (&rows)[4], float threshold, float contrast, std::uint8_t* edges, std::size_t n) {
  for_lanes(n, [&](auto d, std::size_t i) HWY_ATTR { edge_some(d, rows, threshold, contrast, edges, i); });
}

void shape_row(const std::uint8_t* edges, const std::uint8_t* above, std::uint8_t* shapes, std::uint8_t* bits,
               std::size_t n) {
  const hn::CappedTag<std::uint8_t, 32> d;
  const hn::Repartition<std::uint16_t, decltype(d)> wide;
  const auto one = hn::Set(d, std::uint8_t{1}), two = hn::Set(d, std::uint8_t{2});
  const auto level = hn::Set(d, std::uint8_t{5}), upright = hn::Set(d, std::uint8_t{10});
  const auto zero = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    // The bits that are moved up never leave their bytes.
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
const Cmaa2Kernels PerIsa<Cmaa2Kernels>::HWY_NAMESPACE = {.edge_row = HWY_NAMESPACE::edge_row,
                                                          .shape_row = HWY_NAMESPACE::shape_row};
}  // namespace zoneplate
