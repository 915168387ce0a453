// SPDX-License-Identifier: Apache-2.0
// Moving lanes to the front. Included by *_simd.cpp files only.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3

/// The lanes of a mask, a bit each.
template <class D>
HWY_INLINE std::uint32_t bits_of(D, hn::Mask<D> mask) {
  return mask.raw;
}

/// The lanes of a mask, in order, then any.
template <class D>
HWY_INLINE hn::Vec<D> order_of(D d, hn::Mask<D> mask, std::uint32_t) {
  return hn::Compress(hn::Iota(d, 0), mask);
}

#else

/// The lanes of a mask, a bit each.
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

/// For every mask of lanes: the lanes that are set, in order, then the others. (Highway's own table is copied to the
/// stack at each use by GCC 12.)
struct Orders {
  alignas(64) std::uint8_t lane[256][8];
};
constexpr Orders make_orders() {
  Orders out{};
  for (int mask = 0; mask < 256; ++mask) {
    int n = 0;
    for (int bit = 0; bit < 8; ++bit)
      if (mask >> bit & 1) out.lane[mask][n++] = static_cast<std::uint8_t>(bit);
    for (int bit = 0; bit < 8; ++bit)
      if (!(mask >> bit & 1)) out.lane[mask][n++] = static_cast<std::uint8_t>(bit);
  }
  return out;
}
constexpr Orders orders = make_orders();

/// The lanes of a mask, in order, then the others.
template <class D>
HWY_INLINE hn::Vec<D> order_of(D d, hn::Mask<D>, std::uint32_t bits) {
  const hn::Rebind<std::uint8_t, D> bytes;
  return hn::PromoteTo(d, hn::LoadU(bytes, orders.lane[bits]));
}

#endif

/// Moves the lanes of a mask of words to the front. Whole vectors are stored.
template <class D>
class Packing {
 public:
  HWY_INLINE explicit Packing(hn::Mask<D> mask)
      : bits_(bits_of(D(), mask)), order_(hn::IndicesFromVec(D(), order_of(D(), mask, bits_))) {}
  HWY_INLINE void store(hn::Vec<D> v, std::int32_t* to) const { hn::StoreU(hn::TableLookupLanes(v, order_), D(), to); }
  HWY_INLINE void store(hn::Vec<hn::Rebind<float, D>> v, float* to) const {
    store(hn::BitCast(D(), v), reinterpret_cast<std::int32_t*>(to));
  }
  HWY_INLINE std::int32_t count() const { return __builtin_popcount(bits_); }

 private:
  std::uint32_t bits_;
  decltype(hn::IndicesFromVec(D(), hn::Zero(D()))) order_;
};

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
