#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "zoneplate/math/for_lanes_simd.h"

/// Storing edges as bytes, for the instruction set of the including file.
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

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
