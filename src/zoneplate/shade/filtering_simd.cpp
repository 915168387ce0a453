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

/// Which bytes of eight weights go into which lanes, by the two points 2 n and 2 n + 1 that the first block has: that
/// of the first for eight lanes (`odd`: of the second), or of both for four each.
struct Spread {
  alignas(32) std::uint8_t even[8 / points][32], odd[8 / points][32], both[8 / points][32];
};

constexpr Spread make_spread() {
  Spread s{};
  for (int n = 0; n < 8 / points; ++n)
    for (int byte = 0; byte < 32; ++byte) {
      const int first = 2 * n + byte / 16 * 4, half = byte % 2;
      s.even[n][byte] = static_cast<std::uint8_t>(2 * first + half);
      s.odd[n][byte] = static_cast<std::uint8_t>(2 * (first + 1) + half);
      s.both[n][byte] = static_cast<std::uint8_t>(2 * (first + byte % 16 / 8) + half);
    }
  return s;
}
constexpr Spread spread = make_spread();

/// The weights of eight points from `weights` on, in every block.
HWY_INLINE V load_weights(const std::int16_t* weights) { return hn::LoadDup128(Fixed(), weights); }

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

/// The weights of eight points' taps into one level.
struct LevelWeights {
  V right, down;
  LevelWeights(const Taps& taps, int level, int i)
      : right(load_weights(taps.right[level] + i)), down(load_weights(taps.down[level] + i)) {}
};

/// A level of the points i + 2 n and i + 2 n + 1, and of those four on: a point is four lanes.
template <class Codes>
HWY_INLINE V mix_level(const Codes& codes, const Taps& taps, int level, const LevelWeights& weights, int i, int n) {
  const std::int32_t* const upper = taps.upper[level] + i + 2 * n;
  const std::int32_t* const lower = taps.lower[level] + i + 2 * n;
  constexpr int other = blocks == 2 ? 4 : 0;
  // Left and right texels.
  const auto rows = [&](int p, const std::uint8_t* bytes) HWY_ATTR {
    const V up = codes.pair(upper[p], upper[p + other]), low = codes.pair(lower[p], lower[p + other]);
    return mix(up, low, spread_weights(weights.down, bytes));
  };
  const V even = rows(0, spread.even[n]), odd = rows(1, spread.odd[n]);
  return mix(lower_halves(even, odd), upper_halves(even, odd), spread_weights(weights.right, spread.both[n]));
}

/// What mix_level gives of points that follow each other, to channels from point i on.
HWY_INLINE void store_channels(V first, V second, float unit, float* const out[4], int i) {
  const hn::Repartition<std::int32_t, Fixed> di;
  const hn::RebindToFloat<decltype(di)> df;
  const auto a = hn::BitCast(di, first), b = hn::BitCast(di, second);
  const auto rg = even_words(b, a), ba = odd_words(b, a);
  const auto low = hn::Set(di, 0xffff);
  const auto scale = hn::Set(df, unit);
  const auto store = [&](auto codes, float* to)
                         HWY_ATTR { hn::StoreU(hn::Mul(hn::ConvertTo(df, codes), scale), df, to + i); };
  store(hn::And(rg, low), out[0]);
  store(hn::ShiftRight<16>(rg), out[1]);
  store(hn::And(ba, low), out[2]);
  store(hn::ShiftRight<16>(ba), out[3]);
}

template <class Code>
void mix_codes(const Code* of, const Taps& taps, float* const out[4], int count) {
  const TexelCodes<Code> codes{of};
  const hn::FixedTag<std::int16_t, 8> eight;
  for (int i = 0; i < count; i += 8) {
    const LevelWeights weights(taps, 0, i);
    const bool has_second = !hn::AllTrue(eight, hn::Eq(hn::Load(eight, taps.blend + i), hn::Zero(eight)));
    for (int n = 0; n < 8 / points; n += 2) {
      V first = mix_level(codes, taps, 0, weights, i, n), second = mix_level(codes, taps, 0, weights, i, n + 1);
      if (has_second) {
        const LevelWeights weights1(taps, 1, i);
        const V blend = load_weights(taps.blend + i);
        first = mix(first, mix_level(codes, taps, 1, weights1, i, n), spread_weights(blend, spread.both[n]));
        second = mix(second, mix_level(codes, taps, 1, weights1, i, n + 1), spread_weights(blend, spread.both[n + 1]));
      }
      store_channels(first, second, TexelCodes<Code>::unit, out, i + 2 * n);
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
