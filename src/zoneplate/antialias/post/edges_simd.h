#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

/// Edges as bytes, and the way along a row, for the instruction set of the file that includes this.
HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Stores 1 where `left` and 2 where `top` as bytes, one a lane of d, which are words of 32 bits.
template <class D, class M>
HWY_INLINE void store_edges(D d, M left, M top, std::uint8_t* edges) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto bits = hn::Or(hn::IfThenElseZero(left, hn::Set(d, 1)), hn::IfThenElseZero(top, hn::Set(d, 2)));
  hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(di, bits)), bytes, edges);
}

/// some(d, i) for pixels i on of a row of n: for whole vectors first, then for single pixels.
template <class Some>
HWY_INLINE void along_row(std::size_t n, Some some) {
  const hn::CappedTag<float, 8> full;
  const hn::CappedTag<float, 1> one;
  std::size_t i = 0;
  for (; i + hn::Lanes(full) <= n; i += hn::Lanes(full)) some(full, i);
  for (; i < n; ++i) some(one, i);
}

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
