// Moving lanes to the front. Included by *_simd.cpp files only.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

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

/// Moves the lanes of a mask to the front. Whole vectors are stored.
class Packing {
  using I = hn::CappedTag<std::int32_t, 8>;
  static constexpr I i32{};

 public:
  HWY_INLINE explicit Packing(hn::Mask<I> mask) : bits_(bits_of(mask)), order_(order_of(bits_)) {}
  HWY_INLINE void store(hn::Vec<I> v, std::int32_t* to) const { hn::StoreU(hn::TableLookupLanes(v, order_), i32, to); }
  HWY_INLINE void store(hn::Vec<hn::Rebind<float, I>> v, float* to) const {
    store(hn::BitCast(i32, v), reinterpret_cast<std::int32_t*>(to));
  }
  HWY_INLINE std::int32_t count() const { return __builtin_popcount(bits_); }

 private:
  static HWY_INLINE std::uint32_t bits_of(hn::Mask<I> mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(i32, mask, bits);
    return bits[0];
  }
  static HWY_INLINE decltype(hn::IndicesFromVec(i32, hn::Zero(i32))) order_of(std::uint32_t bits) {
    const hn::Rebind<std::uint8_t, I> bytes;
    return hn::IndicesFromVec(i32, hn::PromoteTo(i32, hn::LoadU(bytes, orders.lane[bits])));
  }
  std::uint32_t bits_;
  decltype(hn::IndicesFromVec(i32, hn::Zero(i32))) order_;
};

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
