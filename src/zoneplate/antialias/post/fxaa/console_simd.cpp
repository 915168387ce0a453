// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/antialias/post/fxaa/console.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// The lumas at the four corners of pixels, one pixel per lane.
template <class D>
struct Corners {
  using V = hn::Vec<D>;
  V m, nw, ne, sw, se, high, low;

  HWY_INLINE Corners(D d, const std::uint8_t* p, std::ptrdiff_t stride) {
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> bytes;
    const auto load = [&](std::ptrdiff_t at) HWY_ATTR { return hn::PromoteTo(di, hn::LoadU(bytes, p + at)); };
    const auto sum = [&](auto a, auto b) HWY_ATTR { return hn::Add(a, b); };
    // Each vertical pair is used by two corners.
    const auto here = load(0), north = load(-stride), south = load(stride);
    const auto west = load(-1), east = load(1);
    const auto up = sum(here, north), down = sum(here, south);
    const auto quarter = [&](auto four) HWY_ATTR { return hn::Mul(hn::ConvertTo(d, four), hn::Set(d, 0.25f)); };
    nw = quarter(sum(up, sum(west, load(-stride - 1))));
    ne = hn::Add(quarter(sum(up, sum(east, load(-stride + 1)))), hn::Set(d, FxaaConsoleKernels::nudge));
    sw = quarter(sum(down, sum(west, load(stride - 1))));
    se = quarter(sum(down, sum(east, load(stride + 1))));
    m = hn::ConvertTo(d, here);
    high = hn::Max(hn::Max(nw, ne), hn::Max(sw, se)), low = hn::Min(hn::Min(nw, ne), hn::Min(sw, se));
  }
};

void seen_row(const FxaaConsoleRows& rows, float threshold, float least, std::uint8_t* seen, std::size_t n) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Corners<hn::CappedTag<float, 8>> c(d, rows.luma + i, rows.stride);
    const auto range = hn::Sub(hn::Max(c.high, c.m), hn::Min(c.low, c.m));
    const auto limit = hn::Max(hn::Set(d, least), hn::Mul(c.high, hn::Set(d, threshold)));
    const auto is_seen = hn::RebindMask(di, hn::Ge(range, limit));
    hn::StoreU(hn::DemoteTo(bytes, hn::IfThenElseZero(is_seen, hn::Set(di, 1))), bytes, seen + i);
  }
}

// The four channels of one pixel.
using DF4 = hn::CappedTag<float, 4>;
using VF4 = hn::Vec<DF4>;
constexpr DF4 d4;

HWY_INLINE float min_of(float a, float b) { return b < a ? b : a; }
HWY_INLINE float size_of(float v) { return v < 0 ? -v : v; }

HWY_INLINE VF4 load_codes(const std::uint8_t* p) {
  const hn::Rebind<std::uint8_t, DF4> bytes;
  return hn::ConvertTo(d4, hn::PromoteTo(hn::RebindToSigned<DF4>(), hn::LoadU(bytes, p)));
}

/// A point between four pixels.
struct Point {
  std::ptrdiff_t x, y;  ///< the upper left pixel; y is relative to the row
  float u, v;

  HWY_INLINE Point(std::ptrdiff_t at, float dx, float dy) {
    const int left = floor_of(dx), top = floor_of(dy);
    x = at + left, y = top;
    u = dx - static_cast<float>(left), v = dy - static_cast<float>(top);
  }
  HWY_INLINE float luma(const FxaaConsoleRows& rows) const {
    const std::uint8_t *p = rows.luma + x + y * rows.stride, *below = p + rows.stride;
    const float a = p[0], b = p[1], c = below[0], d = below[1];
    const float upper = a + (b - a) * u, lower = c + (d - c) * u;
    return upper + (lower - upper) * v;
  }
  HWY_INLINE VF4 color(const FxaaConsoleRows& rows, std::ptrdiff_t n) const {
    const auto inside = [n](std::ptrdiff_t i) { return 4 * (i < 0 ? 0 : i < n ? i : n - 1); };
    const std::uint8_t *above = rows.codes[rows.radius + y], *below = rows.codes[rows.radius + y + 1];
    const std::ptrdiff_t first = inside(x), second = inside(x + 1);
    const VF4 upper = mixed(load_codes(above + first), load_codes(above + second), u);
    return mixed(upper, mixed(load_codes(below + first), load_codes(below + second), u), v);
  }

 private:
  static HWY_INLINE int floor_of(float w) {
    const int whole = static_cast<int>(w);
    return static_cast<float>(whole) > w ? whole - 1 : whole;
  }
  static HWY_INLINE VF4 mixed(VF4 a, VF4 b, float t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), hn::Set(d4, t))); }
};

HWY_INLINE VF4 mean(VF4 a, VF4 b) { return hn::Mul(hn::Add(a, b), hn::Set(d4, 0.5f)); }

HWY_INLINE float stretched(float v, float scale) {
  if (v == 0) return 0;
  const float t = v / scale;
  return 2 * (t < -2 ? -2 : t > 2 ? 2 : t);
}

void mix_pixel(const FxaaConsoleRows& rows, float sharpness, std::ptrdiff_t x, std::ptrdiff_t n, std::uint8_t* to) {
  const hn::CappedTag<float, 1> one;
  const Corners<hn::CappedTag<float, 1>> corner(one, rows.luma + x, rows.stride);
  const float nw = hn::GetLane(corner.nw), ne = hn::GetLane(corner.ne), sw = hn::GetLane(corner.sw),
              se = hn::GetLane(corner.se);
  float dx = (sw - ne) + (se - nw), dy = (sw - ne) - (se - nw);
  const float length = hn::GetLane(hn::Sqrt(hn::Set(one, dx * dx + dy * dy)));
  if (!(length > 0)) return;
  dx /= length, dy /= length;
  const Point before(x, -dx * 0.5f, -dy * 0.5f), after(x, dx * 0.5f, dy * 0.5f);
  const float scale = min_of(size_of(dx), size_of(dy)) * sharpness;
  const float fx = stretched(dx, scale), fy = stretched(dy, scale);
  const Point far_before(x, -fx, -fy), far_after(x, fx, fy);

  VF4 out = mean(before.color(rows, n), after.color(rows, n));
  const float near_luma = (before.luma(rows) + after.luma(rows)) * 0.5f;
  const float far_luma = (near_luma + (far_before.luma(rows) + far_after.luma(rows)) * 0.5f) * 0.5f;
  if (!(far_luma < hn::GetLane(corner.low)) && !(far_luma > hn::GetLane(corner.high)))
    out = mean(out, mean(far_before.color(rows, n), far_after.color(rows, n)));
  const hn::Rebind<std::uint8_t, DF4> bytes;
  const VF4 rounded = hn::Add(out, hn::Set(d4, 0.5f));
  hn::StoreU(hn::DemoteTo(bytes, hn::ConvertTo(hn::RebindToSigned<DF4>(), rounded)), bytes, to);
}

void mix_row(const FxaaConsoleRows& rows, float sharpness, const std::uint8_t* seen, std::uint8_t* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (seen[i])
      mix_pixel(rows, sharpness, static_cast<std::ptrdiff_t>(i), static_cast<std::ptrdiff_t>(n), out + 4 * i);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const FxaaConsoleKernels PerIsa<FxaaConsoleKernels>::HWY_NAMESPACE = {.seen_row = HWY_NAMESPACE::seen_row,
                                                                      .mix_row = HWY_NAMESPACE::mix_row};
}  // namespace zoneplate
