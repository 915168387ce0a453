#include "zoneplate/shade/filtering.h"
#include "zoneplate/shade/filtering_stages.h"
#include "zoneplate/shade/lanes_simd.h"
#include "zoneplate/shade/texture_view.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

// A texel's four channels are the lanes here; four points are turned at the end.
using Channels = hn::FixedTag<float, 4>;
using Texel = hn::Vec<Channels>;

template <class Code>
HWY_INLINE Texel load_texel(const Code* codes, std::int32_t number) {
  const hn::FixedTag<Code, 4> narrow;
  const hn::FixedTag<std::int32_t, 4> wide;
  const auto code = hn::LoadU(narrow, codes + std::ptrdiff_t{4} * number);
  return hn::ConvertTo(Channels(), hn::PromoteTo(wide, code));
}

HWY_INLINE Texel mix(Texel a, Texel b, Texel weight) { return hn::Add(a, hn::Mul(hn::Sub(b, a), weight)); }

/// Two texels that lie one after the other, in vectors that have room for both.
using PairChannels = hn::CappedTag<float, 8>;
constexpr bool has_pairs = hn::MaxLanes(PairChannels()) == 8;

template <class Code>
HWY_INLINE hn::Vec<PairChannels> load_pair(const Code* codes, std::int32_t number) {
  const hn::Rebind<Code, PairChannels> narrow;
  const hn::Rebind<std::int32_t, PairChannels> wide;
  const auto code = hn::LoadU(narrow, codes + std::ptrdiff_t{4} * number);
  return hn::ConvertTo(PairChannels(), hn::PromoteTo(wide, code));
}

template <class Code>
HWY_INLINE Texel mix_level(const Code* codes, const Taps& taps, int level, int i) {
  const Texel down = hn::Set(Channels(), taps.down[level][i]);
  if constexpr (has_pairs) {
    // Away from the texture's edges the left and right texels are neighbours: both rows are mixed at once.
    const PairChannels d;
    const std::int32_t upper_left = taps.texel[level][0][i], lower_left = taps.texel[level][2][i];
    if (taps.texel[level][1][i] == upper_left + 1) {
      const auto upper = load_pair(codes, upper_left), lower = load_pair(codes, lower_left);
      const auto left = hn::ConcatLowerLower(d, lower, upper), right = hn::ConcatUpperUpper(d, lower, upper);
      const auto weight = hn::Set(d, taps.right[level][i]);
      const auto mixed = hn::Add(left, hn::Mul(hn::Sub(right, left), weight));
      return mix(hn::LowerHalf(mixed), hn::UpperHalf(Channels(), mixed), down);
    }
  }
  const auto texel = [&](int corner) HWY_ATTR { return load_texel(codes, taps.texel[level][corner][i]); };
  const Texel right = hn::Set(Channels(), taps.right[level][i]);
  const Texel upper = mix(texel(0), texel(1), right);
  const Texel lower = mix(texel(2), texel(3), right);
  return mix(upper, lower, down);
}

template <class Code>
HWY_INLINE Texel mix_point(const Code* codes, float unit, const Taps& taps, int i) {
  Texel value = mix_level(codes, taps, 0, i);
  const float blend = taps.blend[i];
  if (blend > 0) value = mix(value, mix_level(codes, taps, 1, i), hn::Set(Channels(), blend));
  return hn::Mul(value, hn::Set(Channels(), unit));
}

template <class Code>
void mix_codes(const Code* codes, float unit, const Taps& taps, float* const out[4], int count) {
  const Channels d;
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const Texel p0 = mix_point(codes, unit, taps, i), p1 = mix_point(codes, unit, taps, i + 1);
    const Texel p2 = mix_point(codes, unit, taps, i + 2), p3 = mix_point(codes, unit, taps, i + 3);
    const Texel rg01 = hn::InterleaveLower(d, p0, p1), rg23 = hn::InterleaveLower(d, p2, p3);
    const Texel ba01 = hn::InterleaveUpper(d, p0, p1), ba23 = hn::InterleaveUpper(d, p2, p3);
    hn::StoreU(hn::ConcatLowerLower(d, rg23, rg01), d, out[0] + i);
    hn::StoreU(hn::ConcatUpperUpper(d, rg23, rg01), d, out[1] + i);
    hn::StoreU(hn::ConcatLowerLower(d, ba23, ba01), d, out[2] + i);
    hn::StoreU(hn::ConcatUpperUpper(d, ba23, ba01), d, out[3] + i);
  }
  for (; i < count; ++i) {
    float channel[4];
    hn::StoreU(mix_point(codes, unit, taps, i), d, channel);
    for (int c = 0; c < 4; ++c) out[c][i] = channel[c];
  }
}

void mix_taps(const TextureView& t, const Taps& taps, float* const out[4], int count) {
  if (t.codes8 != nullptr) return mix_codes(t.codes8, 1.0f / 255.0f, taps, out, count);
  mix_codes(t.codes16, 1.0f / 65535.0f, taps, out, count);
}

}  // namespace

const FilteringKernels filtering_kernels = {&find_taps<Float, TextureView>, &mix_taps};

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
