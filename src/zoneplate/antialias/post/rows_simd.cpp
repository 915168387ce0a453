// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "zoneplate/antialias/post/rows.h"
#include "zoneplate/math/for_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::CappedTag<std::uint8_t, 32>;
constexpr Bytes db;

void copy(const std::uint8_t* from, std::uint8_t* to, std::size_t n) {
  const std::size_t lanes = hn::Lanes(db);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) hn::StoreU(hn::LoadU(db, from + i), db, to + i);
  for (; i < n; ++i) to[i] = from[i];
}

void stream(const std::uint8_t* from, std::uint8_t* to, std::size_t n) {
  const std::size_t lanes = hn::Lanes(db);
  std::size_t i = 0;
  for (; i < n && reinterpret_cast<std::uintptr_t>(to + i) % lanes != 0; ++i) to[i] = from[i];
  for (; i + lanes <= n; i += lanes) hn::Stream(hn::LoadU(db, from + i), db, to + i);
  for (; i < n; ++i) to[i] = from[i];
  hwy::FlushStream();
}

// All products and sums are integers below 2^24, which floats represent exactly.
template <class D>
HWY_INLINE void luma_some(D d, const std::uint8_t* rgba, float* luma, std::size_t i) {
  const hn::RebindToSigned<D> di;
  const hn::Repartition<std::uint8_t, D> bytes;
  const auto pixels = hn::BitCast(di, hn::LoadU(bytes, rgba + 4 * i));
  const auto mask = hn::Set(di, 255);
  const auto r = hn::ConvertTo(d, hn::And(pixels, mask));
  const auto g = hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(pixels), mask));
  const auto b = hn::ConvertTo(d, hn::And(hn::ShiftRight<16>(pixels), mask));
  const auto rg = hn::Add(hn::Mul(r, hn::Set(d, 2126.0f)), hn::Mul(g, hn::Set(d, 7152.0f)));
  hn::StoreU(hn::Add(rg, hn::Mul(b, hn::Set(d, 722.0f))), d, luma + i);
}

void luma(const std::uint8_t* rgba, float* out, std::size_t n) {
  for_lanes(n, [&](auto d, std::size_t i) HWY_ATTR { luma_some(d, rgba, out, i); });
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const RowKernels PerIsa<RowKernels>::HWY_NAMESPACE = {
    .copy = HWY_NAMESPACE::copy, .stream = HWY_NAMESPACE::stream, .luma = HWY_NAMESPACE::luma};
}  // namespace zoneplate
