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

using Words = hn::ScalableTag<std::int16_t>;
using W = hn::Vec<Words>;
using WMask = hn::Mask<Words>;
constexpr Words dw;
alignas(32) constexpr std::int16_t lane_bits[16] = {1,   2,   4,    8,    16,   32,   64,    128,
                                                    256, 512, 1024, 2048, 4096, 8192, 16384, -32768};

HWY_INLINE W load_luma(const std::uint8_t* p) {
  const hn::Rebind<std::uint8_t, Words> bytes;
  return hn::PromoteTo(dw, hn::LoadU(bytes, p));
}

HWY_INLINE void store_bytes(W v, std::uint8_t* to) {
  const hn::Rebind<std::uint8_t, Words> bytes;
  hn::StoreU(hn::DemoteTo(bytes, v), bytes, to);
}

/// |a + b - 2 c|
HWY_INLINE W bend(W a, W b, W c) { return hn::Abs(hn::Sub(hn::Add(a, b), hn::Add(c, c))); }

/// The edges of a vector of pixels, each with its own direction and side.
struct Walk {
  const std::uint8_t* pixel;
  std::ptrdiff_t stride;
  WMask is_level, is_second;
  bool all_level, none_level;
  W gradient, twice;

  /// The sums of the lumas on both sides of the edge, i pixels along it.
  HWY_INLINE W pair(std::ptrdiff_t i) const {
    W level = hn::Zero(dw), upright = hn::Zero(dw);
    if (!none_level) {
      const std::uint8_t* p = pixel + i;
      level = hn::Add(load_luma(p), hn::IfThenElse(is_second, load_luma(p + stride), load_luma(p - stride)));
    }
    if (!all_level) {
      const std::uint8_t* p = pixel + i * stride;
      upright = hn::Add(load_luma(p), hn::IfThenElse(is_second, load_luma(p + 1), load_luma(p - 1)));
    }
    return hn::IfThenElse(is_level, level, upright);
  }
  /// Four times the luma on the border, `distance` half pixels along it, less that at the pixel.
  HWY_INLINE W error(int distance) const {
    const W first = pair(distance >> 1);
    return hn::Sub(hn::Add(first, distance & 1 ? pair((distance + 1) >> 1) : first), twice);
  }
};

/// One direction of the search.
struct End {
  W distance, error;
  WMask is_done;

  HWY_INLINE void look(const Walk& walk, int sign, int at, int next, WMask& is_tied) {
    const W found = walk.error(sign * at);
    const W size = hn::Abs(found);
    is_tied = hn::Or(is_tied, hn::AndNot(is_done, hn::Eq(size, walk.gradient)));
    error = hn::IfThenElse(is_done, error, found);
    is_done = hn::Or(is_done, hn::Not(hn::Lt(size, walk.gradient)));
    distance = hn::IfThenElse(is_done, distance, hn::Set(dw, static_cast<std::int16_t>(next)));
  }
};

HWY_INLINE W bit_where(WMask mask, int bit) {
  return hn::IfThenElseZero(mask, hn::Set(dw, static_cast<std::int16_t>(bit)));
}

void ends_some(const std::uint8_t* p, std::ptrdiff_t stride, const int* distances, std::size_t count, WMask wanted,
               const FxaaEnds& ends, std::size_t x) {
  const W m = load_luma(p), n = load_luma(p - stride), s = load_luma(p + stride), w = load_luma(p - 1),
          e = load_luma(p + 1);
  const W nw = load_luma(p - stride - 1), ne = load_luma(p - stride + 1), sw = load_luma(p + stride - 1),
          se = load_luma(p + stride + 1);
  const W low = hn::Min(m, hn::Min(hn::Min(n, s), hn::Min(w, e))),
          high = hn::Max(m, hn::Max(hn::Max(n, s), hn::Max(w, e)));
  store_bytes(hn::Sub(high, low), ends.range + x);
  const W near = hn::Add(hn::Add(n, s), hn::Add(w, e)), corners = hn::Add(hn::Add(nw, ne), hn::Add(sw, se));
  const W twelve = hn::Mul(m, hn::Set(dw, std::int16_t{12}));
  const W unlike = hn::Abs(hn::Sub(hn::Add(hn::Add(near, near), corners), twelve));
  const hn::RebindToUnsigned<Words> du;
  hn::StoreU(hn::BitCast(du, unlike), du, ends.unlikeness + x);

  const W middle_h = bend(n, s, m), middle_v = bend(w, e, m);
  const W h = hn::Add(hn::Add(bend(nw, sw, w), bend(ne, se, e)), hn::Add(middle_h, middle_h));
  const W v = hn::Add(hn::Add(bend(nw, ne, n), bend(sw, se, s)), hn::Add(middle_v, middle_v));
  Walk walk{p, stride, hn::Not(hn::Lt(h, v)), {}, false, false, {}, {}};
  const W first = hn::Abs(hn::Sub(hn::IfThenElse(walk.is_level, n, w), m));
  const W second_luma = hn::IfThenElse(walk.is_level, s, e), second = hn::Abs(hn::Sub(second_luma, m));
  walk.is_second = hn::Gt(second, first);
  walk.gradient = hn::Max(first, second);
  walk.all_level = hn::AllFalse(dw, hn::AndNot(walk.is_level, wanted));
  walk.none_level = hn::AllFalse(dw, hn::And(walk.is_level, wanted));
  const W across = hn::IfThenElse(walk.is_second, second_luma, hn::IfThenElse(walk.is_level, n, w));
  const W here = hn::Add(m, across);
  walk.twice = hn::Add(here, here);

  // A pixel that is not wanted is done from the start.
  const W start = hn::Set(dw, static_cast<std::int16_t>(distances[0]));
  End before{start, hn::Zero(dw), hn::Not(wanted)}, after = before;
  WMask is_tied = hn::Lt(start, start);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    before.look(walk, -1, distances[i], distances[i + 1], is_tied);
    after.look(walk, 1, distances[i], distances[i + 1], is_tied);
    if (hn::AllTrue(dw, hn::And(before.is_done, after.is_done))) break;
  }
  const W nearer = hn::IfThenElse(hn::Lt(before.distance, after.distance), before.error, after.error);
  const WMask bends = hn::Xor(hn::Lt(nearer, hn::Zero(dw)), hn::Lt(m, across));
  store_bytes(before.distance, ends.before + x);
  store_bytes(after.distance, ends.after + x);
  store_bytes(
      hn::Or(hn::Or(bit_where(walk.is_level, FxaaEnds::level), bit_where(walk.is_second, FxaaEnds::second_side)),
             hn::Or(bit_where(bends, FxaaEnds::bends), bit_where(is_tied, FxaaEnds::tied))),
      ends.flags + x);
}

void ends_row(const std::uint8_t* luma, std::ptrdiff_t stride, const int* distances, std::size_t count,
              const std::uint8_t* bits, const FxaaEnds& ends, std::size_t n) {
  const std::size_t lanes = hn::Lanes(dw);
  for (std::size_t x = 0; x < n; x += lanes) {
    int wanted = bits[x / 8];
    if (lanes == 16) wanted |= bits[x / 8 + 1] << 8;
    if (wanted == 0) continue;
    // Lane i looks at bit i.
    const W powers = hn::Load(dw, lane_bits);
    const W set = hn::And(hn::Set(dw, static_cast<std::int16_t>(wanted)), powers);
    ends_some(luma + x, stride, distances, count, hn::Eq(set, powers), ends, x);
  }
}

}  // namespace

extern const FxaaKernels fxaa_kernels;
const FxaaKernels fxaa_kernels = {.luma_row = luma_row, .contrast_row = contrast_row, .ends_row = ends_row};

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
