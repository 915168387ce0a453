// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

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

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const LimitKernels PerIsa<LimitKernels>::HWY_NAMESPACE = {.sum = HWY_NAMESPACE::sum, .gather = HWY_NAMESPACE::gather};
}  // namespace zoneplate
