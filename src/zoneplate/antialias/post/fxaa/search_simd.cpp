// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/antialias/post/fxaa/search_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using DI16 = hn::CappedTag<std::int16_t, 16>;
using Sums = hn::RepartitionToWide<DI16>;

/// Narrows two vectors of 32-bit values to one of 16-bit values, in order.
HWY_INLINE hn::Vec<DI16> narrowed(hn::Vec<Sums> first, hn::Vec<Sums> second) {
  constexpr DI16 d;
  constexpr Sums wide;
  if (hn::Lanes(d) <= 8) return hn::ReorderDemote2To(d, first, second);
  // The demotion operates on each half of 128 bits separately.
  return hn::ReorderDemote2To(d, hn::ConcatLowerLower(wide, second, first), hn::ConcatUpperUpper(wide, second, first));
}

HWY_INLINE hn::Vec<Sums> load_codes(const std::uint8_t* rgba) {
  const hn::Repartition<std::uint8_t, Sums> bytes;
  return hn::BitCast(Sums(), hn::LoadU(bytes, rgba));
}

/// An eighth of 299 R + 587 G + 114 B + 500, rounded down: an integer below 2^15.
HWY_INLINE hn::Vec<Sums> eighth_of_sum(hn::Vec<Sums> codes) {
  constexpr Sums d;
  const auto mask = hn::Set(d, 255);
  const auto r = hn::And(codes, mask), g = hn::And(hn::ShiftRight<8>(codes), mask);
  const auto b = hn::And(hn::ShiftRight<16>(codes), mask);
  const auto rg = hn::Add(hn::Mul(r, hn::Set(d, 299)), hn::Mul(g, hn::Set(d, 587)));
  return hn::ShiftRight<3>(hn::Add(hn::Add(rg, hn::Set(d, 500)), hn::Mul(b, hn::Set(d, 114))));
}

/// Applies `of(codes)` to as many pixels as a vector of 16-bit values has lanes.
template <class Of>
HWY_INLINE hn::Vec<DI16> for_codes(const std::uint8_t* rgba, const Of& of) {
  return narrowed(of(load_codes(rgba)), of(load_codes(rgba + 4 * hn::Lanes(Sums()))));
}

HWY_INLINE void store_bytes(hn::Vec<DI16> v, std::uint8_t* to) {
  const hn::Rebind<std::uint8_t, DI16> bytes;
  hn::StoreU(hn::DemoteTo(bytes, v), bytes, to);
}

/// x / 125 for x below 2^15: applied to an eighth of the sum, it gives a thousandth of the sum.
HWY_INLINE hn::Vec<DI16> a_125th(hn::Vec<DI16> x) {
  const hn::RebindToUnsigned<DI16> du;
  const auto quotient = hn::ShiftRight<6>(hn::MulHigh(hn::BitCast(du, x), hn::Set(du, std::uint16_t{33555})));
  return hn::BitCast(DI16(), quotient);
}

void luma_row(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n) {
  const std::size_t lanes = hn::Lanes(DI16());
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes)
    store_bytes(a_125th(for_codes(rgba + 4 * i, [](hn::Vec<Sums> c) HWY_ATTR { return eighth_of_sum(c); })), luma + i);
  for (; i < n; ++i)
    luma[i] =
        static_cast<std::uint8_t>((299 * rgba[4 * i] + 587 * rgba[4 * i + 1] + 114 * rgba[4 * i + 2] + 500) / 1000);
}

void green_row(const std::uint8_t* rgba, std::uint8_t* green, std::size_t n) {
  const std::size_t lanes = hn::Lanes(DI16());
  std::size_t i = 0;
  const auto green_of = [](hn::Vec<Sums> codes)
                            HWY_ATTR { return hn::And(hn::ShiftRight<8>(codes), hn::Set(Sums(), 255)); };
  for (; i + lanes <= n; i += lanes) store_bytes(for_codes(rgba + 4 * i, green_of), green + i);
  for (; i < n; ++i) green[i] = rgba[4 * i + 1];
}

void contrast_row(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                  std::size_t n) {
  const hn::CappedTag<std::uint8_t, 32> d;
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

    // Even and odd bytes are widened in place and processed separately.
    const auto pairs = hn::BitCast(d16, greatest);
    const auto even = hn::MulHigh(hn::And(pairs, low), factor);
    const auto odd = hn::MulHigh(hn::ShiftRight<8>(pairs), factor);
    const auto share = hn::BitCast(d, hn::Or(even, hn::ShiftLeft<8>(odd)));
    const auto excess = hn::SaturatedSub(hn::Sub(greatest, smallest), hn::Max(share, least));
    hn::StoreMaskBits(d, hn::Not(hn::Eq(excess, hn::Zero(d))), bits + i / 8);
  }
}

using VI16 = hn::Vec<DI16>;
using MI16 = hn::Mask<DI16>;
constexpr DI16 dw;
constexpr std::int32_t pixel_bits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
alignas(32) constexpr std::int16_t lane_bits[16] = {1,   2,   4,    8,    16,   32,   64,    128,
                                                    256, 512, 1024, 2048, 4096, 8192, 16384, -32768};

HWY_INLINE VI16 load_luma(const std::uint8_t* p) {
  const hn::Rebind<std::uint8_t, DI16> bytes;
  return hn::PromoteTo(dw, hn::LoadU(bytes, p));
}

using DF = hn::CappedTag<float, 8>;
using VF = hn::Vec<DF>;
constexpr DF df;

HWY_INLINE VF lower(VI16 v) {
  const hn::RebindToSigned<DF> di;
  return hn::ConvertTo(df, hn::PromoteTo(di, hn::LowerHalf(v)));
}
HWY_INLINE VF upper(VI16 v) {
  const hn::RebindToSigned<DF> di;
  const hn::Half<DI16> half;
  return hn::ConvertTo(df, hn::PromoteTo(di, hn::UpperHalf(half, v)));
}

/// |a + b - 2 c|
HWY_INLINE VI16 bend(VI16 a, VI16 b, VI16 c) { return hn::Abs(hn::Sub(hn::Add(a, b), hn::Add(c, c))); }

/// The orientation of the edges of a vector's pixels.
enum class Direction { Level, Upright, Both };

/// The edges of a vector of pixels, each with its own direction and side.
struct Walk {
  const std::uint8_t* pixel;
  std::ptrdiff_t stride;
  MI16 is_level, is_second;
  VI16 gradient, twice;

  /// The sums of the lumas on both sides of the edge, i pixels along it.
  template <Direction direction>
  HWY_INLINE VI16 pair(std::ptrdiff_t i) const {
    if constexpr (direction == Direction::Both) {
      return hn::IfThenElse(is_level, pair<Direction::Level>(i), pair<Direction::Upright>(i));
    } else {
      const bool level = direction == Direction::Level;
      const std::uint8_t* p = pixel + (level ? i : i * stride);
      const std::ptrdiff_t across = level ? stride : 1;
      return hn::Add(load_luma(p), hn::IfThenElse(is_second, load_luma(p + across), load_luma(p - across)));
    }
  }
  /// Four times the luma on the border, `distance` half pixels along it, minus four times that at the pixel.
  template <Direction direction>
  HWY_INLINE VI16 error(int distance) const {
    const VI16 first = pair<direction>(distance >> 1);
    return hn::Sub(hn::Add(first, distance & 1 ? pair<direction>((distance + 1) >> 1) : first), twice);
  }
};

/// One end of the edges: the last tested distance, and the error there.
struct End {
  VI16 distance, error;
};

/// Tests four distances between branches, because a mispredicted branch at the end of the search costs more than
/// additional tests.
template <Direction direction>
HWY_INLINE End find_end(const Walk& walk, const FxaaSearch& search, MI16 selected, int sign) {
  End end{hn::Set(dw, static_cast<std::int16_t>(search.distances[0])), hn::Zero(dw)};
  MI16 goes_on = selected;
  for (std::size_t i = 0; i + 1 < search.count; ++i) {
    if (i % 4 == 0 && hn::AllFalse(dw, goes_on)) break;
    const VI16 found = walk.error<direction>(sign * search.distances[i]);
    end.error = hn::IfThenElse(goes_on, found, end.error);
    goes_on = hn::And(goes_on, hn::Lt(hn::Abs(found), walk.gradient));
    const auto next = static_cast<std::int16_t>(search.distances[i + 1]);
    end.distance = hn::IfThenElse(goes_on, hn::Set(dw, next), end.distance);
  }
  return end;
}

/// Finds both ends with the loop for the vector's orientation: most vectors have only one.
HWY_INLINE void search_ends(const Walk& walk, const FxaaSearch& search, MI16 selected, End& before, End& after) {
  if (hn::AllFalse(dw, hn::AndNot(walk.is_level, selected))) {
    before = find_end<Direction::Level>(walk, search, selected, -1);
    after = find_end<Direction::Level>(walk, search, selected, 1);
  } else if (hn::AllFalse(dw, hn::And(walk.is_level, selected))) {
    before = find_end<Direction::Upright>(walk, search, selected, -1);
    after = find_end<Direction::Upright>(walk, search, selected, 1);
  } else {
    before = find_end<Direction::Both>(walk, search, selected, -1);
    after = find_end<Direction::Both>(walk, search, selected, 1);
  }
}

HWY_INLINE VI16 bit_where(MI16 mask, int bit) {
  return hn::IfThenElseZero(mask, hn::Set(dw, static_cast<std::int16_t>(bit)));
}

/// The greater of the line's shift and that of sub-pixel smoothing, for half a vector.
HWY_INLINE VF shift_of(VF line, VF unlikeness, VF range, float subpixel) {
  const VF one = hn::Set(df, 1.0f);
  const VF ratio = hn::Div(unlikeness, hn::Mul(range, hn::Set(df, 12.0f)));
  const VF c = hn::IfThenElse(hn::Lt(ratio, one), ratio, one);
  const VF slope = hn::Sub(hn::Set(df, 3.0f), hn::Mul(hn::Set(df, 2.0f), c));
  const VF smooth = hn::Mul(hn::Mul(slope, c), c);
  const VF own = hn::Mul(hn::Mul(smooth, smooth), hn::Set(df, subpixel));
  return hn::IfThenElse(hn::Lt(line, own), own, line);
}

/// The offset at which the line through two ends leaves the pixel; 0 if `nearer` is 0.
HWY_INLINE VF line_shift(VF nearer, VF both) {
  const VF share = hn::Sub(hn::Set(df, 0.5f), hn::Div(nearer, both));
  return hn::IfThenElse(hn::Gt(nearer, hn::Zero(df)), share, hn::Zero(df));
}

void ends_some(const std::uint8_t* p, std::ptrdiff_t stride, const FxaaSearch& search, MI16 selected,
               const FxaaEnds& ends, std::size_t x) {
  const VI16 m = load_luma(p), n = load_luma(p - stride), s = load_luma(p + stride), w = load_luma(p - 1),
             e = load_luma(p + 1);
  const VI16 nw = load_luma(p - stride - 1), ne = load_luma(p - stride + 1), sw = load_luma(p + stride - 1),
             se = load_luma(p + stride + 1);
  const VI16 middle_h = bend(n, s, m), middle_v = bend(w, e, m);
  const VI16 h = hn::Add(hn::Add(bend(nw, sw, w), bend(ne, se, e)), hn::Add(middle_h, middle_h));
  const VI16 v = hn::Add(hn::Add(bend(nw, ne, n), bend(sw, se, s)), hn::Add(middle_v, middle_v));
  Walk walk{p, stride, hn::Not(hn::Lt(h, v)), {}, {}, {}};
  const VI16 first = hn::Abs(hn::Sub(hn::IfThenElse(walk.is_level, n, w), m));
  const VI16 second_luma = hn::IfThenElse(walk.is_level, s, e), second = hn::Abs(hn::Sub(second_luma, m));
  walk.is_second = hn::Gt(second, first);
  walk.gradient = hn::Max(first, second);
  const VI16 across = hn::IfThenElse(walk.is_second, second_luma, hn::IfThenElse(walk.is_level, n, w));
  const VI16 here = hn::Add(m, across);
  walk.twice = hn::Add(here, here);

  End before, after;
  search_ends(walk, search, selected, before, after);
  // Pixels with a tie are processed separately, by fxaa_tied_shift.
  const MI16 is_tied =
      hn::Or(hn::Eq(hn::Abs(before.error), walk.gradient), hn::Eq(hn::Abs(after.error), walk.gradient));
  const VI16 nearer = hn::IfThenElse(hn::Lt(before.distance, after.distance), before.error, after.error);
  const MI16 bends = hn::Xor(hn::Lt(nearer, hn::Zero(dw)), hn::Lt(m, across));
  const VI16 least = hn::IfThenElseZero(hn::AndNot(is_tied, bends), hn::Min(before.distance, after.distance));
  const VI16 both = hn::Add(before.distance, after.distance);

  const VI16 low = hn::Min(m, hn::Min(hn::Min(n, s), hn::Min(w, e))),
             high = hn::Max(m, hn::Max(hn::Max(n, s), hn::Max(w, e)));
  const VI16 range = hn::Sub(high, low);
  const VI16 near = hn::Add(hn::Add(n, s), hn::Add(w, e)), corners = hn::Add(hn::Add(nw, ne), hn::Add(sw, se));
  const VI16 twelve = hn::Mul(m, hn::Set(dw, std::int16_t{12}));
  const VI16 unlikeness = hn::Abs(hn::Sub(hn::Add(hn::Add(near, near), corners), twelve));
  hn::StoreU(shift_of(line_shift(lower(least), lower(both)), lower(unlikeness), lower(range), search.subpixel), df,
             ends.shift + x);
  hn::StoreU(shift_of(line_shift(upper(least), upper(both)), upper(unlikeness), upper(range), search.subpixel), df,
             ends.shift + x + hn::Lanes(df));
  store_bytes(hn::Or(bit_where(walk.is_level, FxaaEnds::level), bit_where(walk.is_second, FxaaEnds::second_side)),
              ends.flags + x);
  hn::StoreMaskBits(dw, is_tied, ends.tied_bits + x / 8);
}

/// The first pixels of the blocks of `lanes` pixels, within a part of a row, that contain selected pixels. They are
/// listed before the loop over them, so that its branches are predictable.
struct Blocks {
  static constexpr std::size_t part = 1024;  ///< pixels
  std::size_t count = 0;
  std::uint32_t first[part / 8];
};

template <std::size_t lanes>
HWY_INLINE void list_blocks(const std::uint8_t* bits, std::size_t begin, std::size_t end, Blocks& out) {
  out.count = 0;
  for (std::size_t x = begin; x < end; x += 64)
    for (std::size_t i = x; i < x + 64; i += lanes) {
      out.first[out.count] = static_cast<std::uint32_t>(i);
      out.count += (lanes == 16 ? bits[i / 8] | bits[i / 8 + 1] : bits[i / 8]) != 0;
    }
}

void ends_row(const std::uint8_t* luma, std::ptrdiff_t stride, const FxaaSearch& search, const std::uint8_t* bits,
              const FxaaEnds& ends, std::size_t n) {
  constexpr std::size_t lanes = HWY_MAX_BYTES >= 32 ? 16 : 8;
  const VI16 powers = hn::Load(dw, lane_bits);
  Blocks blocks;
  for (std::size_t begin = 0; begin < n; begin += Blocks::part) {
    const std::size_t end = begin + Blocks::part < n ? begin + Blocks::part : n;
    list_blocks<lanes>(bits, begin, end, blocks);
    for (std::size_t byte = begin / 8; byte < (end + lanes - 1) / lanes * lanes / 8; ++byte) ends.tied_bits[byte] = 0;
    for (std::size_t i = 0; i < blocks.count; ++i) {
      const std::size_t x = blocks.first[i];
      const int selected = bits[x / 8] | (lanes == 16 ? bits[x / 8 + 1] << 8 : 0);
      const VI16 set = hn::And(hn::Set(dw, static_cast<std::int16_t>(selected)), powers);
      ends_some(luma + x, stride, search, hn::Eq(set, powers), ends, x);
    }
  }
}

using DI = hn::RebindToSigned<DF>;
using VI = hn::Vec<DI>;
constexpr DI dp;

/// One channel of (1 - t) here + t there, rounded, at its bit position. After adding 2^23, the code is in the low bits
/// of the float; for all channels but the first, the higher bits are shifted out.
template <int shift>
HWY_INLINE VI mixed_channel(VI here, VI there, VF t) {
  const VI mask = hn::Set(dp, 255);
  const VF from = hn::ConvertTo(df, hn::And(hn::ShiftRight<shift>(here), mask));
  const VF to = hn::ConvertTo(df, hn::And(hn::ShiftRight<shift>(there), mask));
  const VF out = hn::Add(hn::Add(from, hn::Mul(hn::Sub(to, from), t)), hn::Set(df, 0.5f));
  const VI code = hn::BitCast(dp, hn::Add(hn::Floor(out), hn::Set(df, 8388608.0f)));
  return shift == 0 ? hn::And(code, mask) : hn::ShiftLeft<shift>(code);
}

HWY_INLINE VI load_pixels(const std::uint8_t* p) {
  const hn::Repartition<std::uint8_t, DI> bytes;
  return hn::BitCast(dp, hn::LoadU(bytes, p));
}

/// Filters single pixels at the sides of the image.
void mix_few(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int bits,
             const FxaaEnds& ends, std::uint8_t* out, std::size_t begin, std::size_t end, std::size_t n) {
  for (std::size_t i = begin; i < end; ++i)
    if (bits >> (i - begin) & 1) stages::fxaa_mix_pixel(above, here, below, ends, out, i, n);
}

/// Filters eight pixels that have neighbours on both sides.
HWY_INLINE void mix_block(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int bits,
                          const FxaaEnds& ends, std::uint8_t* out, std::size_t x) {
  const hn::Rebind<std::uint8_t, DI> bytes;
  const hn::Repartition<std::uint8_t, DI> whole;
  const VI powers = hn::LoadU(dp, pixel_bits);
  for (std::size_t i = x; i < x + 8; i += hn::Lanes(dp)) {
    const VI set = hn::And(hn::Set(dp, bits >> (i - x)), powers);
    const VI flags = hn::PromoteTo(dp, hn::LoadU(bytes, ends.flags + i));
    const VI level = hn::Set(dp, FxaaEnds::level), second = hn::Set(dp, FxaaEnds::second_side);
    const auto is_second = hn::Eq(hn::And(flags, second), second), is_level = hn::Eq(hn::And(flags, level), level);
    const VI m = load_pixels(here + 4 * i);
    const VI beside = hn::IfThenElse(is_second, load_pixels(here + 4 * i + 4), load_pixels(here + 4 * i - 4));
    const VI over = hn::IfThenElse(is_second, load_pixels(below + 4 * i), load_pixels(above + 4 * i));
    const VI there = hn::IfThenElse(is_level, over, beside);
    const VF t = hn::LoadU(df, ends.shift + i);
    const VI mixed = hn::Or(hn::Or(mixed_channel<0>(m, there, t), mixed_channel<8>(m, there, t)),
                            hn::Or(mixed_channel<16>(m, there, t), mixed_channel<24>(m, there, t)));
    hn::StoreU(hn::BitCast(whole, hn::IfThenElse(hn::Eq(set, powers), mixed, m)), whole, out + 4 * i);
  }
}

void mix_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, const std::uint8_t* bits,
             const FxaaEnds& ends, std::uint8_t* out, std::size_t n) {
  Blocks blocks;
  for (std::size_t begin = 0; begin < n; begin += Blocks::part) {
    list_blocks<8>(bits, begin, begin + Blocks::part < n ? begin + Blocks::part : n, blocks);
    for (std::size_t i = 0; i < blocks.count; ++i) {
      const std::size_t x = blocks.first[i];
      if (x == 0 || x + 9 > n)
        mix_few(above, here, below, bits[x / 8], ends, out, x, x + 8 < n ? x + 8 : n, n);
      else
        mix_block(above, here, below, bits[x / 8], ends, out, x);
    }
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const FxaaKernels PerIsa<FxaaKernels>::HWY_NAMESPACE = {.luma_row = HWY_NAMESPACE::luma_row,
                                                        .green_row = HWY_NAMESPACE::green_row,
                                                        .contrast_row = HWY_NAMESPACE::contrast_row,
                                                        .ends_row = HWY_NAMESPACE::ends_row,
                                                        .mix_row = HWY_NAMESPACE::mix_row};
}  // namespace zoneplate
