#include <hwy/highway.h>

#include "zoneplate/antialias/fxaa_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// The sum of products is below 2^24, so that its floats are exact and its order does not matter.
template <class D>
HWY_INLINE void luma_some(D d, const std::uint8_t* rgba, std::uint8_t* luma, std::size_t i) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::uint8_t, D> d8;
  const hn::Repartition<std::uint8_t, D> bytes;
  const auto pixels = hn::BitCast(di, hn::LoadU(bytes, rgba + 4 * i));
  const auto mask = hn::Set(di, 255);
  const auto r = hn::ConvertTo(d, hn::And(pixels, mask));
  const auto g = hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(pixels), mask));
  const auto b = hn::ConvertTo(d, hn::And(hn::ShiftRight<16>(pixels), mask));
  const auto rg = hn::Add(hn::Mul(r, hn::Set(d, 299.0f)), hn::Mul(g, hn::Set(d, 587.0f)));
  const auto sum = hn::Add(rg, hn::Mul(b, hn::Set(d, 114.0f)));
  const auto scaled = hn::Add(hn::Mul(sum, hn::Set(d, 0.001f)), hn::Set(d, 0.5f));
  hn::StoreU(hn::DemoteTo(d8, hn::ConvertTo(di, scaled)), d8, luma + i);
}

void luma_row(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n) {
  const hn::ScalableTag<float> full;
  const hn::CappedTag<float, 1> one;
  std::size_t i = 0;
  for (; i + hn::Lanes(full) <= n; i += hn::Lanes(full)) luma_some(full, rgba, luma, i);
  for (; i < n; ++i) luma_some(one, rgba, luma, i);
}

void contrast_row(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                  std::size_t n) {
  const hn::ScalableTag<std::uint8_t> d;
  const hn::Repartition<std::uint16_t, decltype(d)> d16;
  const auto factor = hn::Set(d16, contrast.factor);
  const auto low = hn::Set(d16, std::uint16_t{255});
  const auto least = hn::Set(d, contrast.least);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const std::uint8_t* m = luma + i;
    const auto middle = hn::LoadU(d, m);
    const auto north = hn::LoadU(d, m - stride), south = hn::LoadU(d, m + stride);
    const auto west = hn::LoadU(d, m - 1), east = hn::LoadU(d, m + 1);
    const auto greatest = hn::Max(middle, hn::Max(hn::Max(north, south), hn::Max(west, east)));
    const auto smallest = hn::Min(middle, hn::Min(hn::Min(north, south), hn::Min(west, east)));

    // Every second byte at a time, widened where it is.
    const auto pairs = hn::BitCast(d16, greatest);
    const auto even = hn::MulHigh(hn::And(pairs, low), factor);
    const auto odd = hn::MulHigh(hn::ShiftRight<8>(pairs), factor);
    const auto share = hn::BitCast(d, hn::Or(even, hn::ShiftLeft<8>(odd)));
    const auto excess = hn::SaturatedSub(hn::Sub(greatest, smallest), hn::Max(share, least));
    hn::StoreMaskBits(d, hn::Not(hn::Eq(excess, hn::Zero(d))), bits + i / 8);
  }
}

}  // namespace

extern const FxaaKernels fxaa_kernels;
const FxaaKernels fxaa_kernels = {.luma_row = luma_row, .contrast_row = contrast_row};

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
