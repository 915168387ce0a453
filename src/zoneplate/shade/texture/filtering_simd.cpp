// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include "zoneplate/math/halves_simd.h"
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/filtering_lanes.h"
#include "zoneplate/shade/texture/probes_lanes.h"
#include "zoneplate/shade/texture/texture_view.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

// A block of 128 bits holds two neighbouring texels of a row for each of two fragments, as 16-bit lanes in two vectors;
// their mixture has the same form. Eight fragments are one vector of four blocks, two of two or four of one.
using Fixed = hn::CappedTag<std::int16_t, 32>;
using V = hn::Vec<Fixed>;
constexpr int blocks = static_cast<int>(hn::MaxLanes(Fixed())) / 8;
constexpr int vectors = 4 / blocks;

/// The first of the two fragments of a vector's block, chosen so that weights by fours and results are permuted by
/// blocks only.
constexpr int point_of(int vector, int block) {
  return blocks == 1 ? 2 * vector : blocks == 2 ? 2 * vector + 4 * block : block % 2 * 4 + block / 2 * 2;
}

/// x86 has an instruction that multiplies bytes by -128, but none that multiplies them by 128: there values are negated
/// until they are stored, and mix to the same bits.
constexpr bool are_negative = HWY_ARCH_X86 != 0;

/// a + (b - a) × weight / 32768, to the nearest.
HWY_INLINE V mix(V a, V b, V weight) { return hn::Add(a, hn::MulFixedPoint15(hn::Sub(b, a), weight)); }
/// The same for negated values, whose difference is rounded like that of the positive values.
HWY_INLINE V mix_negative(V a, V b, V weight) { return hn::Sub(a, hn::MulFixedPoint15(hn::Sub(a, b), weight)); }

/// Shuffles from the weights by fours to the lanes of a block. `pair`: which two of the four fragments the block has;
/// the 64 bytes from `pair` 0 on serve four blocks.
struct Spread {
  alignas(64) std::uint8_t down[2][32];         ///< four lanes of each fragment
  alignas(64) std::uint8_t down_one[2][2][32];  ///< all of the first fragment, or of the second
  alignas(64) std::uint8_t right[2][32];        ///< two lanes of each fragment, twice
};

constexpr Spread make_spread() {
  Spread s{};
  for (int pair = 0; pair < 2; ++pair)
    for (int byte = 0; byte < 32; ++byte) {
      const int half = byte % 2, lane = byte % 16 / 2;
      s.down[pair][byte] = static_cast<std::uint8_t>(8 + 2 * (2 * pair + lane / 4) + half);
      for (int p = 0; p < 2; ++p) s.down_one[p][pair][byte] = static_cast<std::uint8_t>(8 + 2 * (2 * pair + p) + half);
      s.right[pair][byte] = static_cast<std::uint8_t>(2 * (2 * pair + lane / 2 % 2) + half);
    }
  return s;
}
constexpr Spread spread = make_spread();

/// Vector n of the weights by fours of eight fragments.
HWY_INLINE V load_weights(const std::int16_t* weights, [[maybe_unused]] int n) {
  if constexpr (blocks == 4) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
    return V{_mm512_broadcast_i64x4(_mm256_load_si256(reinterpret_cast<const __m256i*>(weights)))};
#else
    const auto eight = hn::Load(hn::Half<Fixed>(), weights);
    return combined(Fixed(), eight, eight);
#endif
  } else {
    return hn::Load(Fixed(), weights + (blocks == 2 ? 0 : n / 2 * 8));
  }
}

HWY_INLINE V spread_weights(V weights, const std::uint8_t (&bytes)[2][32], int n) {
  const hn::Repartition<std::uint8_t, Fixed> d;
  return hn::BitCast(Fixed(), hn::TableLookupBytes(hn::BitCast(d, weights), hn::Load(d, bytes[n % 2])));
}

/// One weight of each fragment.
HWY_INLINE V spread_each(const std::int16_t* weights, int n) {
  return spread_weights(load_weights(weights, n), spread.right, n);
}

/// The vector whose blocks are block(0), block(1), ...
template <class Load>
HWY_INLINE V join_blocks(Load block) {
  if constexpr (blocks == 4) {
    const hn::Half<Fixed> half;
    return combined(Fixed(), combined(half, block(3), block(2)), combined(half, block(1), block(0)));
  } else if constexpr (blocks == 2) {
    return combined(Fixed(), block(1), block(0));
  } else {
    return block(0);
  }
}

template <int first>
HWY_INLINE V every_second_pair(V upper, V lower) {
  const hn::Repartition<std::int32_t, Fixed> d;
  return hn::BitCast(Fixed(), every_second_word<first>(hn::BitCast(d, upper), hn::BitCast(d, lower)));
}

/// The taps of eight fragments on one level: the numbers of the upper left texels, those of the lower left ones or how
/// many texels further on they are, and the weights by fours.
struct ByLower {
  const std::int32_t *upper, *lower;
  const std::int16_t* weights;
};
struct ByPitch {
  const std::int32_t* upper;
  std::ptrdiff_t pitch;
  const std::int16_t* weights;
};

/// The operands of the mix along x: two channels of each fragment of a block, then its other two.
struct Sides {
  V left, right;
};

/// unorm8 texels, which are widened to 15 bits. The channel pairs are red and blue, green and alpha.
struct Codes8 {
  const std::uint8_t* codes;
  static constexpr bool is_negative = are_negative;
  static constexpr float unit = 1.0f / 32640.0f;
  static constexpr int channel[4] = {0, 2, 1, 3};

  HWY_INLINE const std::uint8_t* at(const std::int32_t* texel, int point) const {
    return codes + std::ptrdiff_t{4} * texel[point];
  }

  /// The texels of the fragments and their right neighbours, in an upper and a lower row.
  struct Rows {
    V upper, lower;
  };

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  static_assert(blocks == 4);
  using Quad = hn::Vec<hn::Half<Fixed>>;

  /// The texels of four fragments and their right neighbours.
  static HWY_INLINE Quad quad(const std::uint8_t* row, std::ptrdiff_t a, std::ptrdiff_t b, std::ptrdiff_t c,
                              std::ptrdiff_t e) {
    const auto load = [&](std::ptrdiff_t texel)
                          HWY_ATTR { return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(row + 4 * texel)); };
    __m256i v = _mm256_castsi128_si256(load(a));
    v = _mm256_mask_broadcastq_epi64(v, 2, load(b));
    v = _mm256_mask_broadcastq_epi64(v, 4, load(c));
    v = _mm256_mask_broadcastq_epi64(v, 8, load(e));
    return Quad{v};
  }
  HWY_INLINE V pairs(const std::int32_t* texel) const {
    const auto four = [&](int p) HWY_ATTR { return quad(codes, texel[p], texel[p + 1], texel[p + 4], texel[p + 5]); };
    return combined(Fixed(), four(2), four(0));
  }
  HWY_INLINE Rows rows(const ByLower& taps, int) const { return {pairs(taps.upper), pairs(taps.lower)}; }

  /// Both rows of four fragments after each other: the processor has no registers for the indices of eight.
  HWY_INLINE Rows rows(const ByPitch& taps, int) const {
    const std::uint8_t* const below = codes + 4 * taps.pitch;
    const std::int32_t* const texel = taps.upper;
    const std::ptrdiff_t a = texel[0], b = texel[1], c = texel[4], e = texel[5];
    const Quad upper = quad(codes, a, b, c, e), lower = quad(below, a, b, c, e);
    const std::ptrdiff_t f = texel[2], g = texel[3], h = texel[6], i = texel[7];
    return {combined(Fixed(), quad(codes, f, g, h, i), upper), combined(Fixed(), quad(below, f, g, h, i), lower)};
  }
#else
  HWY_INLINE V pairs(const std::int32_t* texel, int n) const {
    return join_blocks([&](int block) HWY_ATTR {
      const hn::FixedTag<std::int16_t, 8> d;
      const std::uint8_t *const p = at(texel, point_of(n, block)), *const q = at(texel, point_of(n, block) + 1);
#if HWY_ARCH_X86
      const __m128 first = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
      return hn::Vec<decltype(d)>{_mm_castps_si128(_mm_loadh_pi(first, reinterpret_cast<const __m64*>(q)))};
#else
      const hn::FixedTag<std::uint8_t, 16> bytes;
      const hn::FixedTag<std::uint8_t, 8> half;
      return hn::BitCast(d, hn::Combine(bytes, hn::LoadU(half, q), hn::LoadU(half, p)));
#endif
    });
  }
  HWY_INLINE Rows rows(const ByLower& taps, int n) const { return {pairs(taps.upper, n), pairs(taps.lower, n)}; }
  HWY_INLINE Rows rows(const ByPitch& taps, int n) const {
    return {pairs(taps.upper, n), Codes8{codes + 4 * taps.pitch}.pairs(taps.upper, n)};
  }
#endif

  /// Every second byte × 128, from the first on or the second.
  template <int first>
  static HWY_INLINE V widened(V bytes) {
#if HWY_ARCH_X86
    const auto times = hn::Set(Fixed(), static_cast<std::int16_t>(first == 0 ? 0x0080 : 0x8000));
#if HWY_TARGET <= HWY_AVX3
    return V{_mm512_maddubs_epi16(bytes.raw, times.raw)};
#elif HWY_TARGET <= HWY_AVX2
    return V{_mm256_maddubs_epi16(bytes.raw, times.raw)};
#else
    return V{_mm_maddubs_epi16(bytes.raw, times.raw)};
#endif
#else
    if (first == 0) return hn::ShiftLeft<7>(hn::And(bytes, hn::Set(Fixed(), 0x00ff)));
    return hn::And(hn::ShiftRight<1>(bytes), hn::Set(Fixed(), 0x7f80));
#endif
  }

  template <class At>
  HWY_INLINE Sides sides(const At& taps, V weights, int n) const {
    const Rows row = rows(taps, n);
    const V up = row.upper, low = row.lower, down = spread_weights(weights, spread.down, n);
    const V even = mixed(widened<0>(up), widened<0>(low), down), odd = mixed(widened<1>(up), widened<1>(low), down);
    return {every_second_pair<0>(odd, even), every_second_pair<1>(odd, even)};
  }

  static HWY_INLINE V mixed(V a, V b, V weight) { return is_negative ? mix_negative(a, b, weight) : mix(a, b, weight); }
};

/// unorm15 texels. The channel pairs are red and green, blue and alpha.
struct Codes15 {
  const std::uint16_t* codes;
  static constexpr bool is_negative = false;
  static constexpr float unit = 1.0f / 32767.0f;
  static constexpr int channel[4] = {0, 1, 2, 3};

  /// The texels of one fragment of each block and their right neighbours.
  HWY_INLINE V pairs(const std::int32_t* texel, int n, int p) const {
    return join_blocks([&](int block) HWY_ATTR {
      const std::uint16_t* const from = codes + std::ptrdiff_t{4} * texel[point_of(n, block) + p];
      return hn::LoadU(hn::FixedTag<std::int16_t, 8>(), reinterpret_cast<const std::int16_t*>(from));
    });
  }
  HWY_INLINE V lower_pairs(const ByLower& taps, int n, int p) const { return pairs(taps.lower, n, p); }
  HWY_INLINE V lower_pairs(const ByPitch& taps, int n, int p) const {
    return Codes15{codes + 4 * taps.pitch}.pairs(taps.upper, n, p);
  }
  template <class At>
  HWY_INLINE Sides sides(const At& taps, V weights, int n) const {
    const auto rows = [&](int p) HWY_ATTR {
      return mix(pairs(taps.upper, n, p), lower_pairs(taps, n, p), spread_weights(weights, spread.down_one[p], n));
    };
    const hn::Repartition<std::int32_t, Fixed> d;
    const auto even = hn::BitCast(d, rows(0)), odd = hn::BitCast(d, rows(1));
    return {hn::BitCast(Fixed(), hn::InterleaveLower(d, even, odd)),
            hn::BitCast(Fixed(), hn::InterleaveUpper(d, even, odd))};
  }
  static HWY_INLINE V mixed(V a, V b, V weight) { return mix(a, b, weight); }
};

/// Mixes one level of vector n of eight fragments.
template <class Codes, class At>
HWY_INLINE V mix_level(const Codes& codes, const At& taps, int n) {
  const V weights = load_weights(taps.weights, n);
  const Sides sides = codes.sides(taps, weights, n);
  return Codes::mixed(sides.left, sides.right, spread_weights(weights, spread.right, n));
}

/// The taps of the eight fragments from i on, on one level.
HWY_INLINE ByLower taps_of(const Taps& taps, int level, int i) {
  return {taps.upper[level] + i, taps.lower[level] + i, taps.bilinear_weight[level] + 2 * i};
}

/// Mixes both levels. The result is negated if Codes::is_negative.
template <class Codes>
HWY_INLINE V mix_levels(const Codes& codes, const Taps& taps, bool has_second, int i, int n) {
  const V first = mix_level(codes, taps_of(taps, 0, i), n);
  if (!has_second) return first;
  return Codes::mixed(first, mix_level(codes, taps_of(taps, 1, i), n), spread_each(taps.mip_weight + 2 * i, n));
}

template <class Codes>
HWY_INLINE V positive(V mixed) {
  return Codes::is_negative ? hn::Neg(mixed) : mixed;
}

/// Pairs of channels, each a 32-bit lane, as floats.
template <class D>
struct Channels {
  hn::Vec<D> low, high;
  HWY_INLINE Channels(hn::Vec<hn::RebindToSigned<D>> pairs, float unit) {
    const D d;
    const hn::RebindToSigned<D> di;
    low = hn::Mul(hn::ConvertTo(d, hn::And(pairs, hn::Set(di, 0xffff))), hn::Set(d, unit));
    high = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(pairs)), hn::Set(d, unit));
  }
};

/// Stores the channels of eight fragments, from fragment i on.
template <class Codes>
HWY_INLINE void store_channels(const V (&mixed)[vectors], float* const out[4], int i) {
  using Words = hn::Repartition<std::int32_t, Fixed>;
  using Floats = hn::RebindToFloat<Words>;
  const Words words;
  constexpr auto& channel = Codes::channel;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  alignas(64) static constexpr std::int32_t order[16] = {0, 1, 8, 9, 4, 5, 12, 13, 2, 3, 10, 11, 6, 7, 14, 15};
  const auto pairs = hn::TableLookupLanes(hn::BitCast(words, mixed[0]), hn::SetTableIndices(words, order));
  const Channels<Floats> s(pairs, Codes::unit);
  const hn::Half<Floats> half;
  hn::StoreU(hn::LowerHalf(half, s.low), half, out[channel[0]] + i);
  hn::StoreU(hn::LowerHalf(half, s.high), half, out[channel[1]] + i);
  hn::StoreU(hn::UpperHalf(half, s.low), half, out[channel[2]] + i);
  hn::StoreU(hn::UpperHalf(half, s.high), half, out[channel[3]] + i);
#else
  const hn::Repartition<std::int64_t, Fixed> d;
  for (int n = 0; n < vectors; n += 2) {
    const auto a = hn::BitCast(d, mixed[n]), b = hn::BitCast(d, mixed[n + 1]);
    const Channels<Floats> first(hn::BitCast(words, hn::InterleaveLower(d, a, b)), Codes::unit);
    const Channels<Floats> second(hn::BitCast(words, hn::InterleaveUpper(d, a, b)), Codes::unit);
    const int at = i + 2 * n;
    hn::StoreU(first.low, Floats(), out[channel[0]] + at), hn::StoreU(first.high, Floats(), out[channel[1]] + at);
    hn::StoreU(second.low, Floats(), out[channel[2]] + at), hn::StoreU(second.high, Floats(), out[channel[3]] + at);
  }
#endif
}

/// True if one of the eight fragments from i on needs its second level.
HWY_INLINE bool blends(const Taps& taps, int i) {
  const hn::CappedTag<std::int16_t, 16> d;
  auto any = hn::Zero(d);
  for (std::size_t n = 0; n < 16; n += hn::MaxLanes(d)) any = hn::Or(any, hn::Load(d, taps.mip_weight + 2 * i + n));
  return !hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
}

template <class Codes>
void mix_codes(const Codes& codes, const Taps& taps, float* const to[4], int count) {
  float* const out[4] = {to[0], to[1], to[2], to[3]};
  for (int i = 0; i < count; i += 8) {
    const bool has_second = blends(taps, i);
    V mixed[vectors];
    for (int n = 0; n < vectors; ++n) mixed[n] = positive<Codes>(mix_levels(codes, taps, has_second, i, n));
    store_channels<Codes>(mixed, out, i);
  }
}

template <class At>
HWY_INLINE At taps_of(const ProbeGroup& group, const ProbeTaps& taps, int level) {
  if constexpr (hwy::IsSame<At, ByPitch>()) {
    return {taps.upper[level], group.pitch[level], taps.bilinear_weight[level]};
  } else {
    return {taps.upper[level], taps.lower[level], taps.bilinear_weight[level]};
  }
}

/// Mixes vector n of one probe of eight fragments.
template <class At, bool has_second, class Codes>
HWY_INLINE V mix_probe(const Codes& codes, const ProbeGroup& group, const ProbeTaps& taps, int n) {
  const V first = mix_level(codes, taps_of<At>(group, taps, 0), n);
  if constexpr (!has_second) return first;
  const V second = mix_level(codes, taps_of<At>(group, taps, 1), n);
  return Codes::mixed(first, second, spread_each(group.mip_weight, n));
}

/// Mixes the probes of eight fragments to their mean, and stores it from fragment i on.
template <class At, bool has_second, class Codes>
HWY_INLINE void mix_probe_group(const Codes& codes, const ProbeGroup& group, const ProbeTaps* taps, float* const out[4],
                                int i) {
  V mean[vectors];
  for (int n = 0; n < vectors; ++n) mean[n] = mix_probe<At, has_second>(codes, group, taps[0], n);
  for (int probe = 1; probe < group.probes; ++probe)
    for (int n = 0; n < vectors; ++n) {
      const V weight = spread_each(taps[probe].mean_weight, n);
      mean[n] = Codes::mixed(mean[n], mix_probe<At, has_second>(codes, group, taps[probe], n), weight);
    }
  for (int n = 0; n < vectors; ++n) mean[n] = positive<Codes>(mean[n]);
  store_channels<Codes>(mean, out, i);
}

template <class Codes>
void mix_probe_codes(const Codes& codes, const ProbeList& of, float* const to[4]) {
  float* const out[4] = {to[0], to[1], to[2], to[3]};
  const ProbeTaps* taps = of.taps;
  for (int i = of.first; i < of.last; i += 8) {
    const ProbeGroup& group = of.group[(i - of.first) / 8];
    if (!group.has_pitch) {
      if (group.has_second) {
        mix_probe_group<ByLower, true>(codes, group, taps, out, i);
      } else {
        mix_probe_group<ByLower, false>(codes, group, taps, out, i);
      }
    } else if (group.has_second) {
      mix_probe_group<ByPitch, true>(codes, group, taps, out, i);
    } else {
      mix_probe_group<ByPitch, false>(codes, group, taps, out, i);
    }
    taps += group.probes;
  }
}

/// The four channels of a texel.
using Channels4 = hn::FixedTag<float, 4>;
using Texel = hn::Vec<Channels4>;

HWY_INLINE Texel mix_texels(Texel a, Texel b, int weight) {
  const Channels4 d;
  return hn::Add(a, hn::Mul(hn::Sub(b, a), hn::Set(d, static_cast<float>(weight) * 0x1p-15f)));
}

HWY_INLINE Texel load_texel(const float* values) { return hn::LoadU(Channels4(), values); }
HWY_INLINE Texel load_texel(const Half* values) {
  static_assert(sizeof(Half) == sizeof(std::uint16_t));
  const auto bits = hn::LoadU(hn::FixedTag<std::uint16_t, 4>(), reinterpret_cast<const std::uint16_t*>(values));
  return hn::PromoteTo(Channels4(), hn::BitCast(hn::FixedTag<hwy::float16_t, 4>(), bits));
}

/// The taps of one fragment on one level; weights in 1/32768.
struct OneTap {
  std::int32_t upper, lower;
  int right, down;
};

HWY_INLINE OneTap tap_of(const Taps& taps, int level, int i) {
  return {taps.upper[level][i], taps.lower[level][i], taps.right(level, i), taps.down(level, i)};
}
HWY_INLINE OneTap tap_of(const ProbeGroup& group, const ProbeTaps& taps, int level, int i) {
  const std::int32_t upper = taps.upper[level][i];
  const std::int16_t* const weights = taps.bilinear_weight[level] + Taps::by_fours(i);
  return {upper, group.has_pitch ? upper + group.pitch[level] : taps.lower[level][i], weights[0], weights[4]};
}

/// `Value` is float or Half.
template <class Value>
HWY_INLINE Texel mix_level(const Value* values, const OneTap& tap) {
  const Value* const upper = values + std::ptrdiff_t{4} * tap.upper;
  const Value* const lower = values + std::ptrdiff_t{4} * tap.lower;
  return mix_texels(mix_texels(load_texel(upper), load_texel(lower), tap.down),
                    mix_texels(load_texel(upper + 4), load_texel(lower + 4), tap.down), tap.right);
}

template <class Value>
HWY_INLINE Texel mix_levels(const Value* values, const Taps& taps, int i) {
  const Texel first = mix_level(values, tap_of(taps, 0, i));
  const int mip_weight = taps.mip_weight[Taps::by_fours(i)];
  return mip_weight > 0 ? mix_texels(first, mix_level(values, tap_of(taps, 1, i)), mip_weight) : first;
}
template <class Value>
HWY_INLINE Texel mix_levels(const Value* values, const ProbeGroup& group, const ProbeTaps& taps, int i) {
  const Texel first = mix_level(values, tap_of(group, taps, 0, i));
  const int mip_weight = group.mip_weight[Taps::by_fours(i)];
  return mip_weight > 0 ? mix_texels(first, mix_level(values, tap_of(group, taps, 1, i)), mip_weight) : first;
}

HWY_INLINE void store_texel(Texel mixed, float* const out[4], int i) {
  alignas(16) float channel[4];
  hn::Store(mixed, Channels4(), channel);
  for (int c = 0; c < 4; ++c) out[c][i] = channel[c];
}

/// Floats and half floats, fragment by fragment.
template <class Value>
void mix_values(const Value* values, const Taps& taps, float* const out[4], int count) {
  for (int i = 0; i < count; ++i) store_texel(mix_levels(values, taps, i), out, i);
}

template <class Value>
void mix_probe_values(const Value* values, const ProbeList& of, float* const out[4]) {
  const ProbeTaps* taps = of.taps;
  for (int i = of.first; i < of.last; i += 8) {
    const ProbeGroup& group = of.group[(i - of.first) / 8];
    for (int k = 0; k < 8; ++k) {
      Texel mean = mix_levels(values, group, taps[0], k);
      for (int n = 1; n < group.probes; ++n) {
        const int weight = taps[n].mean_weight[Taps::by_fours(k)];
        if (weight > 0) mean = mix_texels(mean, mix_levels(values, group, taps[n], k), weight);
      }
      store_texel(mean, out, i + k);
    }
    taps += group.probes;
  }
}

void mix_taps(const TextureView& t, const Taps& taps, float* const out[4], int count) {
  if (t.unorm8 != nullptr) return mix_codes(Codes8{t.unorm8}, taps, out, count);
  if (t.unorm15 != nullptr) return mix_codes(Codes15{t.unorm15}, taps, out, count);
  if (t.halves != nullptr) return mix_values(t.halves, taps, out, count);
  mix_values(t.values, taps, out, count);
}

void mix_probes(const TextureView& t, const ProbeList& probes, float* const out[4]) {
  if (t.unorm8 != nullptr) return mix_probe_codes(Codes8{t.unorm8}, probes, out);
  if (t.unorm15 != nullptr) return mix_probe_codes(Codes15{t.unorm15}, probes, out);
  if (t.halves != nullptr) return mix_probe_values(t.halves, probes, out);
  mix_probe_values(t.values, probes, out);
}

/// Two vectors of eight lanes in one of sixteen.
struct JoinedEights {
  using Float = WideFloat;
  [[maybe_unused]] static constexpr bool exists = true;
  template <class Half>
  static HWY_INLINE auto join(Half lower, Half upper) {
    using Whole = std::conditional_t<hwy::IsSame<Half, HWY_NAMESPACE::Float>(), WideFloat, WideFloat::Int>;
    return Whole(combined(hn::DFromV<decltype(Whole::v)>(), upper.v, lower.v));
  }
};
using Joined = std::conditional_t<WideFloat::lanes == 16, JoinedEights, NotJoined<Float>>;

void sample_anisotropic(const TextureView& t, const SamplerState& f, const Footprint& at, float* const out[4],
                        int count) {
  zoneplate::sample_anisotropic<Float, WideFloat, Joined>(
      t, f, at, count, [&](const ProbeList& probes) HWY_ATTR { mix_probes(t, probes, out); });
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const FilteringKernels PerIsa<FilteringKernels>::HWY_NAMESPACE = {
    .compute_taps = &zoneplate::compute_taps<HWY_NAMESPACE::WideFloat, TextureView>,
    .mix_taps = &HWY_NAMESPACE::mix_taps,
    .sample_anisotropic = &HWY_NAMESPACE::sample_anisotropic};
}  // namespace zoneplate
