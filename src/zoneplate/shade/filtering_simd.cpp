#include "zoneplate/math/halves_simd.h"
#include "zoneplate/shade/filtering.h"
#include "zoneplate/shade/filtering_stages.h"
#include "zoneplate/shade/lanes_simd.h"
#include "zoneplate/shade/texture_view.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

// Two neighbouring texels are the eight 16-bit lanes of a block of 128 bits. Where vectors have two blocks, the second
// is of the point four further on; so four points, or two, are mixed at once.
using Fixed = hn::CappedTag<std::int16_t, 16>;
using V = hn::Vec<Fixed>;
constexpr int blocks = static_cast<int>(hn::MaxLanes(Fixed())) / 8;
constexpr int points = 2 * blocks;

/// Eight codes at each of two places, widened to fixed point; only the first where vectors have one block.
template <class D>
HWY_INLINE hn::Vec<D> load_pairs(D d, const std::uint8_t* first, [[maybe_unused]] const std::uint8_t* second) {
  const hn::FixedTag<std::uint8_t, 8> codes;
  const hn::FixedTag<std::int16_t, 8> block;
  const auto at = [&](const std::uint8_t* p) HWY_ATTR { return hn::PromoteTo(block, hn::LoadU(codes, p)); };
  if constexpr (blocks == 2) {
    return hn::ShiftLeft<7>(combined(d, at(second), at(first)));
  } else {
    return hn::ShiftLeft<7>(at(first));
  }
}

template <class D>
HWY_INLINE hn::Vec<D> load_pairs(D d, const std::uint16_t* first, [[maybe_unused]] const std::uint16_t* second) {
  const hn::FixedTag<std::int16_t, 8> block;
  const auto at = [&](const std::uint16_t* p)
                      HWY_ATTR { return hn::LoadU(block, reinterpret_cast<const std::int16_t*>(p)); };
  if constexpr (blocks == 2) {
    return combined(d, at(second), at(first));
  } else {
    return at(first);
  }
}

template <class Code>
struct TexelCodes {
  const Code* codes;
  static constexpr float unit = sizeof(Code) == 1 ? 1.0f / 32640.0f : 1.0f / 32767.0f;
  HWY_INLINE V pair(std::int32_t first, std::int32_t second) const {
    return load_pairs(Fixed(), codes + std::ptrdiff_t{4} * first, codes + std::ptrdiff_t{4} * second);
  }
};

HWY_INLINE V mix(V a, V b, V weight) { return hn::Add(a, hn::MulFixedPoint15(hn::Sub(b, a), weight)); }

/// Which bytes of the weights by fours go into which lanes of a block, by the points p and p + 1 of the four that the
/// block has: of the lower texels' weights that of the first for eight lanes, or of the second; of the right ones' that
/// of each for four.
struct Spread {
  alignas(32) std::uint8_t down[4][32], right[2][32];
};

constexpr Spread make_spread() {
  Spread s{};
  for (int byte = 0; byte < 32; ++byte) {
    const int half = byte % 2, lane = byte % 16 / 2;
    for (int p = 0; p < 4; ++p) s.down[p][byte] = static_cast<std::uint8_t>(8 + 2 * p + half);
    for (int pair = 0; pair < 2; ++pair)
      s.right[pair][byte] = static_cast<std::uint8_t>(2 * (2 * pair + lane / 4) + half);
  }
  return s;
}
constexpr Spread spread = make_spread();

/// The weights by fours of the points i + 2 n and i + 2 n + 1, and of those four on if vectors have two blocks.
HWY_INLINE V load_weights(const std::int16_t* weights, int i, int n) {
  return hn::Load(Fixed(), weights + 2 * i + (blocks == 2 ? 0 : n / 2 * 8));
}

HWY_INLINE V spread_weights(V weights, const std::uint8_t* bytes) {
  const hn::Repartition<std::uint8_t, Fixed> d;
  return hn::BitCast(Fixed(), hn::TableLookupBytes(hn::BitCast(d, weights), hn::Load(d, bytes)));
}

HWY_INLINE V lower_halves(V a, V b) {
  const hn::Repartition<std::uint64_t, Fixed> d;
  return hn::BitCast(Fixed(), hn::InterleaveLower(d, hn::BitCast(d, a), hn::BitCast(d, b)));
}
HWY_INLINE V upper_halves(V a, V b) {
  const hn::Repartition<std::uint64_t, Fixed> d;
  return hn::BitCast(Fixed(), hn::InterleaveUpper(d, hn::BitCast(d, a), hn::BitCast(d, b)));
}

/// A level of the points i + 2 n and i + 2 n + 1, and of those four on: a point is four lanes.
template <class Codes>
HWY_INLINE V mix_level(const Codes& codes, const Taps& taps, int level, int i, int n) {
  const std::int32_t* const upper = taps.upper[level] + i + 2 * n;
  const std::int32_t* const lower = taps.lower[level] + i + 2 * n;
  const V weights = load_weights(taps.side[level], i, n);
  constexpr int other = blocks == 2 ? 4 : 0;
  // Left and right texels.
  const auto rows = [&](int p) HWY_ATTR {
    const V up = codes.pair(upper[p], upper[p + other]), low = codes.pair(lower[p], lower[p + other]);
    return mix(up, low, spread_weights(weights, spread.down[n % 2 * 2 + p]));
  };
  const V even = rows(0), odd = rows(1);
  return mix(lower_halves(even, odd), upper_halves(even, odd), spread_weights(weights, spread.right[n % 2]));
}

/// Both levels.
template <class Codes>
HWY_INLINE V mix_levels(const Codes& codes, const Taps& taps, bool has_second, int i, int n) {
  const V first = mix_level(codes, taps, 0, i, n);
  if (!has_second) return first;
  const V blend = spread_weights(load_weights(taps.blend, i, n), spread.right[n % 2]);
  return mix(first, mix_level(codes, taps, 1, i, n), blend);
}

/// What mix_level gives of points that follow each other, to channels from point i on.
HWY_INLINE void store_channels(V first, V second, float unit, float* const out[4], int i) {
  const hn::Repartition<std::int32_t, Fixed> di;
  const hn::RebindToFloat<decltype(di)> df;
  const auto a = hn::BitCast(di, first), b = hn::BitCast(di, second);
  const auto rg = every_second_word<0>(b, a), ba = every_second_word<1>(b, a);
  const auto low = hn::Set(di, 0xffff);
  const auto scale = hn::Set(df, unit);
  const auto store = [&](auto codes, float* to)
                         HWY_ATTR { hn::StoreU(hn::Mul(hn::ConvertTo(df, codes), scale), df, to + i); };
  store(hn::And(rg, low), out[0]);
  store(hn::ShiftRight<16>(rg), out[1]);
  store(hn::And(ba, low), out[2]);
  store(hn::ShiftRight<16>(ba), out[3]);
}

/// True if one of eight points from i on needs its second level.
HWY_INLINE bool blends(const Taps& taps, int i) {
  const V zero = hn::Zero(Fixed());
  V any = zero;
  for (int n = 0; n < 4; n += points) any = hn::Or(any, load_weights(taps.blend, i, n));
  return !hn::AllTrue(Fixed(), hn::Eq(any, zero));
}

template <class Code>
void mix_codes(const Code* of, const Taps& taps, float* const to[4], int count) {
  const TexelCodes<Code> codes{of};
  float* const out[4] = {to[0], to[1], to[2], to[3]};
  for (int i = 0; i < count; i += 8) {
    const bool has_second = blends(taps, i);
    for (int n = 0; n < 8 / points; n += 2) {
      const V first = mix_levels(codes, taps, has_second, i, n);
      store_channels(first, mix_levels(codes, taps, has_second, i, n + 1), TexelCodes<Code>::unit, out, i + 2 * n);
    }
  }
}

void mix_taps(const TextureView& t, const Taps& taps, float* const out[4], int count) {
  if (t.codes8 != nullptr) return mix_codes(t.codes8, taps, out, count);
  mix_codes(t.codes15, taps, out, count);
}

void sample_anisotropic(const TextureView& t, const Filtering& f, const Footprint& at, float* const out[4], int count) {
  zoneplate::sample_anisotropic<Float>(t, f, at, out, count,
                                       [&](const Taps& taps, float* const probe[4], int n)
                                           HWY_ATTR { mix_taps(t, taps, probe, n); });
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
const FilteringKernels FilteringKernels::HWY_NAMESPACE = {&zoneplate::find_taps<HWY_NAMESPACE::Float, TextureView>,
                                                          &HWY_NAMESPACE::mix_taps, &HWY_NAMESPACE::sample_anisotropic};
}  // namespace zoneplate
