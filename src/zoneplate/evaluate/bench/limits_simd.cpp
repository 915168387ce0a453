// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include <atomic>

#include "zoneplate/evaluate/bench/limits.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

template <class V>
HWY_INLINE std::uint32_t total(V v) {
  const hn::DFromV<V> d;
  std::uint32_t lane[HWY_MAX_BYTES / sizeof(std::uint32_t)], sum = 0;
  hn::StoreU(v, d, lane);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) sum += lane[i];
  return sum;
}

// Four independent sums, so that the additions do not wait for each other.
template <class Load>
HWY_INLINE std::uint32_t sum_of(std::size_t n, const Load& load) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  auto a = hn::Zero(d), b = a, c = a, e = a;
  for (std::size_t i = 0; i < n; i += 4 * lanes) {
    a = hn::Add(a, load(i));
    b = hn::Add(b, load(i + lanes));
    c = hn::Add(c, load(i + 2 * lanes));
    e = hn::Add(e, load(i + 3 * lanes));
  }
  return total(hn::Add(hn::Add(a, b), hn::Add(c, e)));
}

std::uint32_t sum(const std::uint32_t* words, std::size_t n) {
  const hn::CappedTag<std::uint32_t, 8> d;
  return sum_of(n, [&](std::size_t i) HWY_ATTR { return hn::LoadU(d, words + i); });
}

std::uint32_t gather(const std::uint32_t* table, const std::int32_t* index, std::size_t n) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const hn::RebindToSigned<decltype(d)> i32;
  return sum_of(n, [&](std::size_t i) HWY_ATTR { return hn::GatherIndex(d, table, hn::LoadU(i32, index + i)); });
}

// Twelve independent sums, as many as hide the latency of an addition to the same one.
std::uint32_t multiply(const std::int16_t* values, std::size_t turns) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::Repartition<std::int16_t, decltype(d)> narrow;
  const std::size_t lanes = hn::Lanes(narrow);
  const auto three = hn::Set(narrow, std::int16_t{3});
  auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0, s8 = s0, s9 = s0, s10 = s0,
       s11 = s0, rest = s0;
  const auto add = [&](auto& sum, const std::int16_t* at)
                       HWY_ATTR { sum = hn::ReorderWidenMulAccumulate(d, hn::LoadU(narrow, at), three, sum, rest); };
  for (std::size_t turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < LimitKernels::factors; i += 12 * lanes) {
      const std::int16_t* const at = values + i;
      add(s0, at), add(s1, at + lanes), add(s2, at + 2 * lanes), add(s3, at + 3 * lanes);
      add(s4, at + 4 * lanes), add(s5, at + 5 * lanes), add(s6, at + 6 * lanes), add(s7, at + 7 * lanes);
      add(s8, at + 8 * lanes), add(s9, at + 9 * lanes), add(s10, at + 10 * lanes), add(s11, at + 11 * lanes);
    }
    std::atomic_signal_fence(std::memory_order_seq_cst);  // the values are read again in every turn
  }
  const auto low = hn::Add(hn::Add(hn::Add(s0, s1), hn::Add(s2, s3)), hn::Add(s4, s5));
  const auto high = hn::Add(hn::Add(hn::Add(s6, s7), hn::Add(s8, s9)), hn::Add(s10, s11));
  const hn::RebindToUnsigned<decltype(d)> u32;
  return total(hn::BitCast(u32, hn::RearrangeToOddPlusEven(hn::Add(low, high), rest)));
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const LimitKernels PerIsa<LimitKernels>::HWY_NAMESPACE = {
    .sum = HWY_NAMESPACE::sum, .gather = HWY_NAMESPACE::gather, .multiply = HWY_NAMESPACE::multiply};
}  // namespace zoneplate
