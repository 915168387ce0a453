// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/antialias/post/ddaa/pixels.h"
#include "zoneplate/math/for_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Constants = DdaaConstants;
using DF = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;
constexpr DF df;
constexpr DI di;

HWY_INLINE VF set(float v) { return hn::Set(df, v); }
HWY_INLINE VF root(const float* p) { return hn::Sqrt(hn::LoadU(df, p)); }
HWY_INLINE VF twice(VF v) { return hn::Mul(set(2), v); }

template <class D>
HWY_INLINE void power_some(D d, const std::uint8_t* rgba, float* power, std::size_t i) {
  const hn::RebindToSigned<D> dn;
  const hn::Repartition<std::uint8_t, D> bytes;
  const auto codes = hn::BitCast(dn, hn::LoadU(bytes, rgba + 4 * i)), mask = hn::Set(dn, 255);
  const auto r = hn::And(codes, mask), g = hn::And(hn::ShiftRight<8>(codes), mask);
  const auto b = hn::And(hn::ShiftRight<16>(codes), mask);
  const auto rg = hn::Add(hn::Mul(r, hn::Set(dn, 299)), hn::Mul(g, hn::Set(dn, 587)));
  const auto sum = hn::ConvertTo(d, hn::Add(rg, hn::Mul(b, hn::Set(dn, 114))));
  hn::StoreU(hn::Div(sum, hn::Set(d, 255000.0f)), d, power + i);
}

void power_row(const std::uint8_t* rgba, float* power, std::size_t n) {
  for_lanes(n, [&](auto d, std::size_t i) HWY_ATTR { power_some(d, rgba, power, i); });
}

void seen_row(const float* power, std::ptrdiff_t stride, float threshold, float least, std::uint8_t* seen,
              std::size_t n) {
  const hn::Rebind<std::uint8_t, DF> bytes;
  for (std::size_t i = 0; i < n; i += hn::Lanes(df)) {
    const float* p = power + i;
    const VF m = hn::LoadU(df, p), north = hn::LoadU(df, p - stride), south = hn::LoadU(df, p + stride);
    const VF west = hn::LoadU(df, p - 1), east = hn::LoadU(df, p + 1);
    const VF high = hn::Max(m, hn::Max(hn::Max(north, south), hn::Max(west, east)));
    const VF low = hn::Min(m, hn::Min(hn::Min(north, south), hn::Min(west, east)));
    const VF greatest = hn::Sqrt(high), range = hn::Sub(greatest, hn::Sqrt(low));
    const MF is_wide = hn::Ge(range, hn::Max(set(least), hn::Mul(greatest, set(threshold))));
    const auto is_seen = hn::RebindMask(di, hn::And(is_wide, hn::Lt(low, high)));
    hn::StoreU(hn::DemoteTo(bytes, hn::IfThenElseZero(is_seen, hn::Set(di, 1))), bytes, seen + i);
  }
}

/// The orientation of the edges of a vector's pixels.
enum class Direction { Level, Upright, Both };

/// The edges of a vector of pixels, each with its own direction and side.
struct Walk {
  const float* pixel;
  std::ptrdiff_t stride;
  MF is_level, is_second;
  VF average, least;

  /// The power on this side of the edge, i pixels along it, and on the other side.
  template <Direction direction>
  HWY_INLINE void pair(std::ptrdiff_t i, VF& here, VF& across) const {
    if constexpr (direction == Direction::Both) {
      VF level, beyond;
      pair<Direction::Level>(i, level, beyond);
      pair<Direction::Upright>(i, here, across);
      here = hn::IfThenElse(is_level, level, here), across = hn::IfThenElse(is_level, beyond, across);
    } else {
      const bool level = direction == Direction::Level;
      const float* p = pixel + (level ? i : i * stride);
      const std::ptrdiff_t step = level ? stride : 1;
      here = hn::LoadU(df, p);
      across = hn::IfThenElse(is_second, hn::LoadU(df, p + step), hn::LoadU(df, p - step));
    }
  }
};

/// One end of the edges: its distance, and the difference of its luma from the edge's.
struct End {
  VF distance, off;
};

template <Direction direction>
HWY_INLINE End find_end(const Walk& walk, MF selected, int sign) {
  End end{set(Constants::search + 1), hn::Zero(df)};
  MF goes_on = selected;
  for (int i = 1; i <= Constants::search; ++i) {
    if (i % 2 != 0 && hn::AllFalse(df, goes_on)) break;
    VF here, across;
    walk.pair<direction>(sign * i, here, across);
    const VF luma = i == 1 ? hn::Mul(hn::Add(hn::Sqrt(here), hn::Sqrt(across)), set(0.5f))
                           : hn::Sqrt(hn::Mul(hn::Add(here, across), set(0.5f)));
    const VF off = hn::Sub(luma, walk.average);
    end.off = hn::IfThenElse(goes_on, off, end.off);
    const MF is_end = hn::And(goes_on, hn::Ge(hn::Abs(off), walk.least));
    end.distance = hn::IfThenElse(is_end, set(static_cast<float>(i)), end.distance);
    goes_on = hn::AndNot(is_end, goes_on);
  }
  return end;
}

template <Direction direction>
HWY_INLINE VF search_offset(const Walk& walk, MF selected, MF is_below) {
  const End before = find_end<direction>(walk, selected, -1), after = find_end<direction>(walk, selected, 1);
  const MF is_before = hn::Lt(before.distance, after.distance);
  const VF off = hn::IfThenElse(is_before, before.off, after.off);
  const VF share = hn::Div(hn::Min(before.distance, after.distance), hn::Add(before.distance, after.distance));
  return hn::IfThenElseZero(hn::Xor(hn::Lt(off, hn::Zero(df)), is_below), hn::Sub(set(0.5f), share));
}

/// |a + b - 2 c|
HWY_INLINE VF bend(VF a, VF b, VF c) { return hn::Abs(hn::Sub(hn::Add(a, b), twice(c))); }

HWY_INLINE VF at_most_one(VF v) { return hn::Min(set(1), v); }

void taps_some(const float* p, std::ptrdiff_t stride, float most, MF selected, float* taps) {
  const VF zero = hn::Zero(df);
  const VF m = root(p), n = root(p - stride), s = root(p + stride), w = root(p - 1), e = root(p + 1);
  const VF nw = root(p - stride - 1), ne = root(p - stride + 1), sw = root(p + stride - 1), se = root(p + stride + 1);
  const VF h = hn::Add(hn::Add(bend(nw, sw, w), twice(bend(n, s, m))), bend(ne, se, e));
  const VF v = hn::Add(hn::Add(bend(nw, ne, n), twice(bend(w, e, m))), bend(sw, se, s));
  const MF is_level = hn::Ge(h, v);

  const VF middle = set(Constants::scharr_middle), corner = set(Constants::scharr_corner);
  const VF gx = hn::Add(hn::Mul(middle, hn::Sub(w, e)), hn::Mul(corner, hn::Sub(hn::Add(sw, nw), hn::Add(se, ne))));
  const VF gy = hn::Add(hn::Mul(middle, hn::Sub(n, s)), hn::Mul(corner, hn::Sub(hn::Add(nw, ne), hn::Add(sw, se))));
  const VF length = hn::Sqrt(hn::Add(hn::Mul(gy, gy), hn::Mul(gx, gx)));
  VF strength = at_most_one(hn::Mul(set(most), hn::Sqrt(length)));
  const MF is_still = hn::Lt(strength, set(1e-6f));
  const VF dx = hn::IfThenElse(is_still, zero, hn::Div(hn::Neg(gy), length));
  const VF dy = hn::IfThenElse(is_still, zero, hn::Div(gx, length));

  const VF first = hn::Sub(hn::IfThenElse(is_level, n, w), m), second = hn::Sub(hn::IfThenElse(is_level, s, e), m);
  const VF size = hn::Abs(first), other = hn::Abs(second);
  const MF above = hn::Xor(hn::Gt(first, zero), hn::Gt(second, zero));
  const MF below = hn::Xor(hn::Lt(first, zero), hn::Lt(second, zero));
  const VF ridge = hn::Sub(set(1), at_most_one(hn::Mul(set(10), hn::Min(size, other))));
  strength = hn::IfThenElse(hn::Or(above, below), strength, hn::Mul(strength, ridge));

  const MF is_second = hn::Gt(other, size);
  const VF there = hn::Add(m, hn::IfThenElse(is_second, second, first));
  const VF average = hn::Mul(hn::Add(m, there), set(0.5f));
  const Walk walk{p, stride, is_level, is_second, average, hn::Mul(set(0.25f), hn::Abs(hn::Sub(there, m)))};
  const MF is_below = hn::Lt(m, average);
  VF offset;
  if (hn::AllFalse(df, hn::AndNot(is_level, selected)))
    offset = search_offset<Direction::Level>(walk, selected, is_below);
  else if (hn::AllFalse(df, hn::And(is_level, selected)))
    offset = search_offset<Direction::Upright>(walk, selected, is_below);
  else
    offset = search_offset<Direction::Both>(walk, selected, is_below);

  strength = hn::Mul(strength, hn::Sub(set(1), at_most_one(hn::Abs(twice(offset)))));
  const VF moved = hn::IfThenElse(is_second, offset, hn::Neg(offset)),
           spread = hn::Mul(set(Constants::diffusion_step), strength);
  const VF x = hn::IfThenElse(is_level, zero, moved), y = hn::IfThenElse(is_level, moved, zero);
  const VF across = hn::Mul(dx, spread), down = hn::Mul(dy, spread);
  hn::StoreInterleaved4(hn::Sub(x, across), hn::Sub(y, down), hn::Add(x, across), hn::Add(y, down), df, taps);
}

void taps_row(const float* power, std::ptrdiff_t stride, float strength, const std::uint8_t* seen, float* taps,
              std::size_t n) {
  const hn::Rebind<std::uint8_t, DF> bytes;
  for (std::size_t i = 0; i < n; i += hn::Lanes(df)) {
    const MF selected =
        hn::RebindMask(df, hn::Not(hn::Eq(hn::PromoteTo(di, hn::LoadU(bytes, seen + i)), hn::Zero(di))));
    if (!hn::AllFalse(df, selected)) taps_some(power + i, stride, strength, selected, taps + 4 * i);
  }
}

// The four channels of one pixel.
using DF4 = hn::CappedTag<float, 4>;
using VF4 = hn::Vec<DF4>;
constexpr DF4 d4;

HWY_INLINE int floor_of(float v) {
  const int whole = static_cast<int>(v);
  return static_cast<float>(whole) > v ? whole - 1 : whole;
}

HWY_INLINE VF4 load_codes(const std::uint8_t* p) {
  const hn::Rebind<std::uint8_t, DF4> bytes;
  return hn::ConvertTo(d4, hn::PromoteTo(hn::RebindToSigned<DF4>(), hn::LoadU(bytes, p)));
}

HWY_INLINE VF4 fetch(const std::uint8_t* const* rows, std::ptrdiff_t x, std::ptrdiff_t n, float dx, float dy) {
  const int left = floor_of(dx), top = floor_of(dy);
  const VF4 u = hn::Set(d4, dx - static_cast<float>(left)), v = hn::Set(d4, dy - static_cast<float>(top));
  const VF4 one = hn::Set(d4, 1.0f), rest_u = hn::Sub(one, u), rest_v = hn::Sub(one, v);
  const auto inside = [n](std::ptrdiff_t i) { return 4 * (i < 0 ? 0 : i < n ? i : n - 1); };
  const std::ptrdiff_t first = inside(x + left), second = inside(x + left + 1);
  const std::uint8_t *a = rows[2 + top], *b = rows[3 + top];
  const VF4 upper = hn::Add(hn::Mul(load_codes(a + first), rest_u), hn::Mul(load_codes(a + second), u));
  const VF4 lower = hn::Add(hn::Mul(load_codes(b + first), rest_u), hn::Mul(load_codes(b + second), u));
  return hn::Add(hn::Mul(upper, rest_v), hn::Mul(lower, v));
}

void fetch_row(const std::uint8_t* const* rows, const float* taps, const std::uint8_t* seen, std::uint8_t* out,
               std::size_t n) {
  const hn::Rebind<std::uint8_t, DF4> bytes;
  for (std::size_t i = 0; i < n; ++i) {
    if (!seen[i]) continue;
    const auto x = static_cast<std::ptrdiff_t>(i), width = static_cast<std::ptrdiff_t>(n);
    const float* t = taps + 4 * i;
    const VF4 sum = hn::Add(fetch(rows, x, width, t[0], t[1]), fetch(rows, x, width, t[2], t[3]));
    const VF4 rounded = hn::Add(hn::Mul(sum, hn::Set(d4, 0.5f)), hn::Set(d4, 0.5f));
    hn::StoreU(hn::DemoteTo(bytes, hn::ConvertTo(hn::RebindToSigned<DF4>(), rounded)), bytes, out + 4 * i);
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const DdaaKernels PerIsa<DdaaKernels>::HWY_NAMESPACE = {.power_row = HWY_NAMESPACE::power_row,
                                                        .seen_row = HWY_NAMESPACE::seen_row,
                                                        .taps_row = HWY_NAMESPACE::taps_row,
                                                        .fetch_row = HWY_NAMESPACE::fetch_row};
}  // namespace zoneplate
