// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png/png_rows.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

void up(const std::uint8_t* row, const std::uint8_t* above, std::size_t n, std::uint8_t* out) {
  const hn::CappedTag<std::uint8_t, 32> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) hn::StoreU(hn::Sub(hn::LoadU(d, row + i), hn::LoadU(d, above + i)), d, out + i);
  for (; i < n; ++i) out[i] = static_cast<std::uint8_t>(row[i] - above[i]);
}

void up_rgb(const std::uint8_t* row, const std::uint8_t* above, std::size_t n, std::uint8_t* out) {
  const hn::CappedTag<std::uint8_t, 16> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    hn::Vec<decltype(d)> r, g, b, a, above_r, above_g, above_b, above_a;
    hn::LoadInterleaved4(d, row + 4 * i, r, g, b, a);
    hn::LoadInterleaved4(d, above + 4 * i, above_r, above_g, above_b, above_a);
    hn::StoreInterleaved3(hn::Sub(r, above_r), hn::Sub(g, above_g), hn::Sub(b, above_b), d, out + 3 * i);
  }
  for (; i < n; ++i)
    for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = static_cast<std::uint8_t>(row[4 * i + c] - above[4 * i + c]);
}

/// The sum of all lanes, which are integers, so that the order of addition does not matter.
template <class V>
HWY_INLINE std::uint64_t total(V v) {
  const hn::DFromV<V> d;
  hn::TFromD<decltype(d)> lane[HWY_MAX_BYTES / sizeof(hn::TFromD<decltype(d)>)];
  hn::StoreU(v, d, lane);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) sum += static_cast<std::uint64_t>(lane[i]);
  return sum;
}

std::uint32_t adler(const std::uint8_t* p, std::size_t n) {
  const hn::CappedTag<std::uint8_t, 32> bytes;
  const hn::Half<decltype(bytes)> half;
  const hn::RepartitionToWide<decltype(bytes)> words;
  const hn::Rebind<std::int16_t, decltype(half)> i16;
  const hn::Repartition<std::int32_t, decltype(i16)> i32;
  const hn::Repartition<std::uint64_t, decltype(words)> u64;
  const std::size_t lanes = hn::Lanes(bytes);
  // Within a vector of n bytes, byte j is a term of n - j prefix sums.
  const auto first = hn::Sub(hn::Set(i16, static_cast<std::int16_t>(lanes)), hn::Iota(i16, 0));
  const auto second = hn::Sub(first, hn::Set(i16, static_cast<std::int16_t>(lanes / 2)));
  std::uint64_t sum = 1, sums = 0;
  while (n >= lanes) {
    // The number of vectors is limited so that no lane overflows.
    const std::size_t vectors = n / lanes < 4096 ? n / lanes : 4096;
    auto all = hn::Zero(u64), before = hn::Zero(u64);
    auto weighted = hn::Zero(i32), weighted_too = hn::Zero(i32);
    for (std::size_t i = 0; i < vectors; ++i, p += lanes) {
      const auto v = hn::LoadU(bytes, p);
      before = hn::Add(before, all);
      all = hn::Add(all, hn::SumsOf8(v));
      const auto low = hn::PromoteTo(i16, hn::LowerHalf(half, v)), high = hn::PromoteTo(i16, hn::UpperHalf(half, v));
      weighted = hn::ReorderWidenMulAccumulate(i32, low, first, weighted, weighted_too);
      weighted = hn::ReorderWidenMulAccumulate(i32, high, second, weighted, weighted_too);
    }
    sums = (sums + sum * (vectors * lanes) + total(before) * lanes + total(weighted) + total(weighted_too)) % 65521;
    sum = (sum + total(all)) % 65521;
    n -= vectors * lanes;
  }
  for (; n > 0; --n) {
    sum = (sum + *p++) % 65521;
    sums = (sums + sum) % 65521;
  }
  return static_cast<std::uint32_t>(sums << 16 | sum);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const PngRowKernels PerIsa<PngRowKernels>::HWY_NAMESPACE = {
    .up = HWY_NAMESPACE::up, .up_rgb = HWY_NAMESPACE::up_rgb, .adler = HWY_NAMESPACE::adler};
}  // namespace zoneplate
