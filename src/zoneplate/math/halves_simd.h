// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

/// Vectors composed of parts of two vectors, for the instruction set of the file that includes this header.
HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// hn::Combine, by one instruction for vectors of at least 256 bits, for which Highway first clears the upper half.
template <class D, class Half>
HWY_INLINE hn::Vec<D> combined(D d, Half upper, Half lower) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  using T = hn::TFromD<D>;
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(hn::Vec<D>) == 64) {
    if constexpr (hwy::IsSame<T, float>()) {
      return hn::Vec<D>{_mm512_insertf32x8(_mm512_castps256_ps512(lower.raw), upper.raw, 1)};
    } else if constexpr (!hwy::IsFloat<T>()) {
      return hn::Vec<D>{_mm512_inserti64x4(_mm512_castsi256_si512(lower.raw), upper.raw, 1)};
    }
  }
#endif
  if constexpr (sizeof(hn::Vec<D>) == 32) {
    if constexpr (hwy::IsSame<T, float>()) {
      return hn::Vec<D>{_mm256_insertf128_ps(_mm256_castps128_ps256(lower.raw), upper.raw, 1)};
    } else if constexpr (!hwy::IsFloat<T>()) {
      return hn::Vec<D>{_mm256_inserti128_si256(_mm256_castsi128_si256(lower.raw), upper.raw, 1)};
    }
  }
#endif
  return hn::Combine(d, upper, lower);
}

/// The concatenation of quad(i), quad(i + 4), quad(i + 8) and quad(i + 12), four lanes each: as many as the vector has
/// capacity for.
template <class D, class Quad>
HWY_INLINE hn::Vec<D> every_fourth_quad(D d, const Quad& quad, int i) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return quad(i);
  } else {
    const hn::Half<D> half;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
    return combined(d, every_fourth_quad(half, quad, i + lanes / 2), every_fourth_quad(half, quad, i));
  }
}

/// Every second word of each block of 128 bits, starting at word `first`, of `lower` followed by `upper`.
template <int first, class V>
HWY_INLINE V every_second_word(V upper, V lower) {
  static_assert(first == 0 || first == 1);
  const hn::DFromV<V> d;
  static_assert(sizeof(hn::TFromD<decltype(d)>) == 4);
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  if constexpr (sizeof(V) == 32) {
    constexpr int chosen = first == 0 ? 0x88 : 0xdd;
    const hn::RebindToFloat<decltype(d)> f;
    return hn::BitCast(
        d, hn::Vec<decltype(f)>{_mm256_shuffle_ps(hn::BitCast(f, lower).raw, hn::BitCast(f, upper).raw, chosen)});
  }
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(V) == 64) {
    constexpr int chosen = first == 0 ? 0x88 : 0xdd;
    const hn::RebindToFloat<decltype(d)> f;
    return hn::BitCast(
        d, hn::Vec<decltype(f)>{_mm512_shuffle_ps(hn::BitCast(f, lower).raw, hn::BitCast(f, upper).raw, chosen)});
  }
#endif
#endif
  return first == 0 ? hn::ConcatEven(d, upper, lower) : hn::ConcatOdd(d, upper, lower);
}

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
