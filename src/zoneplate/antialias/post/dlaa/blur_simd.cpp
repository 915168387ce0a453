// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/antialias/post/dlaa/blur_lanes.h"
#include "zoneplate/math/for_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Encoded values of pixels as 16-bit words: red and blue of each in one vector, green in another, interleaved with
/// zeros.
template <class D>
struct Codes {
  using Words = hn::RepartitionToNarrow<D>;
  hn::Vec<Words> red_blue, green;

  HWY_INLINE Codes(D d, const std::uint8_t* rgba) {
    const hn::Repartition<std::uint8_t, D> bytes;
    const auto pixels = hn::BitCast(d, hn::LoadU(bytes, rgba));
    red_blue = hn::BitCast(Words(), hn::And(pixels, hn::Set(d, 0x00FF00FF)));
    green = hn::BitCast(Words(), hn::And(hn::ShiftRight<8>(pixels), hn::Set(d, 0xFF)));
  }
};

/// The sum of red, green and blue of non-negative words, one pixel per lane.
template <class D, class V>
HWY_INLINE hn::Vec<D> sum_of(D d, V red_blue, V green) {
  const auto rb = hn::BitCast(d, red_blue);
  return hn::Add(hn::Add(hn::And(rb, hn::Set(d, 0xFFFF)), hn::ShiftRight<16>(rb)), hn::BitCast(d, green));
}

/// The sum of |a + b - 2 c|.
template <class D>
HWY_INLINE hn::Vec<D> bend(D d, const Codes<D>& a, const Codes<D>& b, const Codes<D>& c) {
  const auto of = [](auto p, auto q, auto m) HWY_ATTR { return hn::Abs(hn::Sub(hn::Add(p, q), hn::Add(m, m))); };
  return sum_of(d, of(a.red_blue, b.red_blue, c.red_blue), of(a.green, b.green, c.green));
}

template <class D>
HWY_INLINE void store_bytes(D d, hn::Vec<D> v, std::uint8_t* to) {
  const hn::Rebind<std::uint8_t, D> bytes;
  static_cast<void>(d);
  hn::StoreU(hn::DemoteTo(bytes, v), bytes, to);
}

template <class D>
HWY_INLINE void edge_some(D d, const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                          std::uint8_t* edges, std::size_t i) {
  const std::uint8_t* p = here + 4 * i;
  const Codes<D> l(d, p - 4), r(d, p + 4), t(d, above + 4 * i), b(d, below + 4 * i), c(d, p);
  const auto off = [](auto left, auto right, auto top, auto bottom, auto middle) HWY_ATTR {
    const auto around = hn::Add(hn::Add(left, right), hn::Add(top, bottom));
    return hn::Abs(hn::Sub(around, hn::ShiftLeft<2>(middle)));
  };
  const auto sum = sum_of(d, off(l.red_blue, r.red_blue, t.red_blue, b.red_blue, c.red_blue),
                          off(l.green, r.green, t.green, b.green, c.green));
  // Divides integers below 2^15 by 3, rounding down.
  const auto four = hn::Add(hn::ShiftLeft<2>(sum), hn::Set(d, 1));
  const auto third = hn::ShiftRight<16>(hn::Mul(four, hn::Set(d, 21846)));
  store_bytes(d, hn::Min(third, hn::Set(d, 255)), edges + i);
}

void edge_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, std::uint8_t* edges,
              std::size_t n) {
  for_lanes<std::int32_t>(n, [&](auto d, std::size_t i) HWY_ATTR { edge_some(d, above, here, below, edges, i); });
}

using DSums = hn::CappedTag<std::int16_t, 16>;
HWY_INLINE hn::Vec<DSums> load_codes(const std::uint8_t* p) {
  const hn::Rebind<std::uint8_t, DSums> bytes;
  return hn::PromoteTo(DSums(), hn::LoadU(bytes, p));
}

void sum_row(const std::uint8_t* edges, std::int16_t* sums, std::size_t n) {
  const DSums d;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    auto sum = load_codes(edges + i);
    for (int k = 1; k <= 8; ++k) sum = hn::Add(sum, hn::Add(load_codes(edges + i - k), load_codes(edges + i + k)));
    hn::StoreU(sum, d, sums + i);
  }
}

void slide_row(const std::uint8_t* added, const std::uint8_t* removed, std::int16_t* sums, std::size_t n) {
  const DSums d;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d))
    hn::StoreU(hn::Add(hn::LoadU(d, sums + i), hn::Sub(load_codes(added + i), load_codes(removed + i))), d, sums + i);
}

template <class D>
HWY_INLINE void seen_some(D d, const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                          const std::int16_t* level, const std::int16_t* upright, int min_bend, int min_sum,
                          std::uint8_t* seen, std::size_t i) {
  const hn::Rebind<std::int16_t, D> words;
  const std::uint8_t* p = here + 4 * i;
  const Codes<D> c(d, p);
  const auto across = bend(d, Codes<D>(d, p - 4), Codes<D>(d, p + 4), c);
  const auto down = bend(d, Codes<D>(d, above + 4 * i), Codes<D>(d, below + 4 * i), c);
  const auto sum =
      hn::Max(hn::PromoteTo(d, hn::LoadU(words, level + i)), hn::PromoteTo(d, hn::LoadU(words, upright + i)));
  const auto is_bent = hn::Gt(hn::Max(across, down), hn::Set(d, min_bend));
  const auto is_long = hn::Gt(sum, hn::Set(d, min_sum));
  store_bytes(d, hn::IfThenElseZero(hn::Or(is_bent, is_long), hn::Set(d, 1)), seen + i);
}

void seen_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, const std::int16_t* level,
              const std::int16_t* upright, int min_bend, int min_sum, std::uint8_t* seen, std::size_t n) {
  for_lanes<std::int32_t>(n, [&](auto d, std::size_t i) HWY_ATTR {
    seen_some(d, above, here, below, level, upright, min_bend, min_sum, seen, i);
  });
}

// The four channels of one pixel, and functions of its luma.
using DF4 = hn::CappedTag<float, 4>;
using DI4 = hn::RebindToSigned<DF4>;
using VF4 = hn::Vec<DF4>;
using VI4 = hn::Vec<DI4>;
constexpr DF4 d4;
constexpr DI4 di4;
using Constants = DlaaConstants;

HWY_INLINE VI4 load_codes4(const std::uint8_t* p) {
  const hn::Rebind<std::uint8_t, DF4> bytes;
  return hn::PromoteTo(di4, hn::LoadU(bytes, p));
}

struct Value {
  VF4 rgba;
  float luma;
  HWY_INLINE explicit Value(VF4 v) : rgba(v) {
    alignas(16) float c[4];
    hn::Store(v, d4, c);
    luma = (c[0] + c[1] + c[2]) / 3;
  }
};
HWY_INLINE VF4 shares_of(VI4 codes) { return hn::Div(hn::ConvertTo(d4, codes), hn::Set(d4, 255.0f)); }
HWY_INLINE VF4 mixed(VF4 a, VF4 b, float t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), hn::Set(d4, t))); }
HWY_INLINE float saturated(float v) { return v > 0 ? (v < 1 ? v : 1.0f) : 0.0f; }

/// The sum of |a + b - 2 c| over the colours.
HWY_INLINE int bend4(VI4 a, VI4 b, VI4 c) {
  alignas(16) std::int32_t sums[4];
  hn::Store(hn::Abs(hn::Sub(hn::Add(a, b), hn::Add(c, c))), di4, sums);
  return sums[0] + sums[1] + sums[2];
}
HWY_INLINE float edge_of(int bend) {
  return Constants::lambda * (static_cast<float>(bend) / (3 * 2 * 255)) - Constants::epsilon;
}

HWY_INLINE VF4 between(VF4 first_value, const Value& c, VF4 last_value, const Value& blur) {
  const Value first(first_value), last(last_value);
  const float to_first = c.luma - first.luma, to_last = c.luma - last.luma;
  const float a = to_first == 0 ? 1.0f : saturated((blur.luma - first.luma) / to_first);
  const float b = to_last == 0 ? 1.0f : saturated(1 + (blur.luma - c.luma) / to_last);
  return mixed(last_value, mixed(first_value, c.rgba, a), b);
}

HWY_INLINE Value long_blur(const std::uint8_t* pixel, std::ptrdiff_t step) {
  VI4 sum = hn::Zero(di4);
  for (int i = 1; i <= Constants::half_blur; ++i)
    sum = hn::Add(sum, hn::Add(load_codes4(pixel - i * step), load_codes4(pixel + i * step)));
  return Value(hn::Div(hn::ConvertTo(d4, sum), hn::Set(d4, static_cast<float>(Constants::whole))));
}

HWY_INLINE VF4 blurred(VF4 two, VF4 one, VF4 next, VF4 after, VF4 c) {
  const VF4 sum = hn::Add(hn::Add(hn::Add(two, one), next), after);
  return hn::Mul(hn::Add(sum, hn::Mul(c, hn::Set(d4, 2.0f))), hn::Set(d4, 1.0f / 6));
}

void blur_pixel(const std::uint8_t* p, std::ptrdiff_t s, float level_mask, float upright_mask, std::uint8_t* to) {
  const VI4 ci = load_codes4(p), li = load_codes4(p - 4), ri = load_codes4(p + 4), ti = load_codes4(p - s),
            bi = load_codes4(p + s);
  const int level_bend = bend4(li, ri, ci), upright_bend = bend4(ti, bi, ci);
  const float unlike = level_mask - upright_mask;
  const bool has_long = (unlike < 0 ? -unlike : unlike) > Constants::min_unlike;
  if (level_bend <= Constants::unseen_bend && upright_bend <= Constants::unseen_bend && !has_long) return;
  const float level = edge_of(level_bend), upright = edge_of(upright_bend);
  const VF4 c = shares_of(ci), l = shares_of(li), r = shares_of(ri), t = shares_of(ti), b = shares_of(bi);
  const Value along(blurred(shares_of(load_codes4(p - 8)), l, r, shares_of(load_codes4(p + 8)), c));
  const Value down(blurred(shares_of(load_codes4(p - 2 * s)), t, b, shares_of(load_codes4(p + 2 * s)), c));
  VF4 out = mixed(c, along.rgba, saturated(upright / along.luma));
  out = mixed(out, down.rgba, 0.5f * saturated(level / down.luma));
  if (has_long) {
    const Value here(c);
    out = mixed(out, between(l, here, r, long_blur(p, s)), upright_mask);
    out = mixed(out, between(t, here, b, long_blur(p, 4)), level_mask);
  }
  const hn::Rebind<std::uint8_t, DF4> bytes;
  const VF4 rounded = hn::Add(hn::Mul(out, hn::Set(d4, 255.0f)), hn::Set(d4, 0.5f));
  hn::StoreU(hn::DemoteTo(bytes, hn::ConvertTo(di4, rounded)), bytes, to);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const DlaaKernels PerIsa<DlaaKernels>::HWY_NAMESPACE = {.edge_row = HWY_NAMESPACE::edge_row,
                                                        .sum_row = HWY_NAMESPACE::sum_row,
                                                        .slide_row = HWY_NAMESPACE::slide_row,
                                                        .seen_row = HWY_NAMESPACE::seen_row,
                                                        .blur_row = stages::dlaa_blur_row<HWY_NAMESPACE::blur_pixel>};
}  // namespace zoneplate
