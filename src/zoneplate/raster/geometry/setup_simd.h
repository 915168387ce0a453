// SPDX-License-Identifier: Apache-2.0
// Setup of a vector of triangles, one a lane: the twin of make_triangle. Included by *_simd.cpp files only.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/math/halves_simd.h"
#include "zoneplate/math/wasm_double_simd.h"
#include "zoneplate/raster/geometry/setup.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// One triangle a lane.
using DF = hn::CappedTag<float, 16>;
using DI = hn::Rebind<std::int32_t, DF>;
using DH = hn::Half<DF>;
using DD = hn::Rebind<double, DH>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VD = hn::Vec<DD>;
using MI = hn::Mask<DI>;
constexpr std::int32_t lanes = static_cast<std::int32_t>(hn::MaxLanes(DF()));
constexpr DF f;
constexpr DI i32;
constexpr DD f64;

HWY_INLINE VI set(std::int32_t v) { return hn::Set(i32, v); }

/// The vertices of a vector of triangles: x and y in 1/256 pixel from the image's top-left corner.
struct Corners {
  VI x[3], y[3];
  VF z[3];
  VI id;
};

struct Extent {
  VI low_x, high_x, low_y, high_y;
};

HWY_INLINE Extent extent_of(const Corners& c) {
  return {hn::Min(hn::Min(c.x[0], c.x[1]), c.x[2]), hn::Max(hn::Max(c.x[0], c.x[1]), c.x[2]),
          hn::Min(hn::Min(c.y[0], c.y[1]), c.y[2]), hn::Max(hn::Max(c.y[0], c.y[1]), c.y[2])};
}

/// The vertices index[0], index[3], index[6] ..., by member.
HWY_INLINE void load(const ScreenVertex* screen, const std::uint32_t* index, VI& x, VI& y, VF& z, VF& w) {
  const auto vertex = [&](int triangle) HWY_ATTR {
    return hn::LoadU(hn::FixedTag<float, 4>(), reinterpret_cast<const float*>(screen + index[3 * triangle]));
  };
  const VF r0 = every_fourth_quad(f, vertex, 0), r1 = every_fourth_quad(f, vertex, 1);
  const VF r2 = every_fourth_quad(f, vertex, 2), r3 = every_fourth_quad(f, vertex, 3);
  const VF xy02 = hn::InterleaveLower(f, r0, r2), xy13 = hn::InterleaveLower(f, r1, r3);
  const VF zw02 = hn::InterleaveUpper(f, r0, r2), zw13 = hn::InterleaveUpper(f, r1, r3);
  x = hn::BitCast(i32, hn::InterleaveLower(f, xy02, xy13));
  y = hn::BitCast(i32, hn::InterleaveUpper(f, xy02, xy13));
  z = hn::InterleaveLower(f, zw02, zw13);
  w = hn::InterleaveUpper(f, zw02, zw13);
}

/// The triangles index[0..2], index[3..5] ..., and the lanes that have a vertex which needs clipping.
HWY_INLINE MI load(const ScreenVertex* screen, const std::uint32_t* index, Viewport viewport, Corners& c) {
  VF w[3];
  load(screen, index, c.x[0], c.y[0], c.z[0], w[0]);
  load(screen, index + 1, c.x[1], c.y[1], c.z[1], w[1]);
  load(screen, index + 2, c.x[2], c.y[2], c.z[2], w[2]);
  const VI centre_x = set(viewport.width * 128), centre_y = set(viewport.height * 128);
  c.x[0] = hn::Add(c.x[0], centre_x), c.y[0] = hn::Add(c.y[0], centre_y);
  c.x[1] = hn::Add(c.x[1], centre_x), c.y[1] = hn::Add(c.y[1], centre_y);
  c.x[2] = hn::Add(c.x[2], centre_x), c.y[2] = hn::Add(c.y[2], centre_y);
  return hn::RebindMask(i32, hn::Eq(hn::Min(hn::Min(w[0], w[1]), w[2]), hn::Zero(f)));
}

template <class M, class V>
HWY_INLINE void swap_where(M mask, V& p, V& q) {
  const V t = hn::IfThenElse(mask, q, p);
  q = hn::IfThenElse(mask, p, q);
  p = t;
}

/// The setup of a vector of triangles that small triangles and records share.
struct SetUp {
  VI dx[3], dy[3];  ///< the edges opposite to the vertices, clockwise
  VI bias[3];       ///< -1 where a point on the edge is outside
  VI area;          ///< doubled
  VI origin_x, origin_y;
  VD z0[2], dzdx[2], dzdy[2];  ///< depth at vertex 0 and its gradients per 1/256 pixel: lower and upper lanes
  VF step_x, step_y;           ///< gradients per pixel
  VF z_low, z_high;
};

template <int half, class V>
HWY_INLINE VD widened(V v) {
  const hn::Half<hn::DFromV<V>> d;
  if constexpr (half == 0) return hn::PromoteTo(f64, hn::LowerHalf(d, v));
  return hn::PromoteTo(f64, hn::UpperHalf(d, v));
}

HWY_INLINE VF narrowed(VD lower, VD upper) {
  const DH h;
  return combined(f, hn::DemoteTo(h, upper), hn::DemoteTo(h, lower));
}

/// The gradients of make_triangle, in its order of operations.
template <int half>
HWY_INLINE void set_up_depth(const Corners& c, SetUp& t) {
  const VD z0 = widened<half>(c.z[0]);
  const VD dz1 = hn::Sub(widened<half>(c.z[1]), z0), dz2 = hn::Sub(widened<half>(c.z[2]), z0);
  // The edge opposite to vertex 2 goes from vertex 0 to vertex 1; the edge opposite to 1 goes from vertex 2 to 0.
  const VD dx1 = widened<half>(t.dx[2]), dy1 = widened<half>(t.dy[2]);
  const VD dx2 = widened<half>(hn::Sub(c.x[2], c.x[0])), dy2 = widened<half>(hn::Sub(c.y[2], c.y[0]));
  const VD inverse_area = hn::Div(hn::Set(f64, 1.0), widened<half>(t.area));
  t.z0[half] = z0;
  t.dzdx[half] = hn::Mul(hn::Sub(hn::Mul(dz1, dy2), hn::Mul(dz2, dy1)), inverse_area);
  t.dzdy[half] = hn::Mul(hn::Sub(hn::Mul(dz2, dx1), hn::Mul(dz1, dx2)), inverse_area);
}

/// The edge opposite to vertex k.
template <int k>
HWY_INLINE void set_up_edge(const Corners& c, EdgeRule rule, SetUp& t) {
  constexpr int from = (k + 1) % 3, to = (k + 2) % 3;
  t.dx[k] = hn::Sub(c.x[to], c.x[from]);
  t.dy[k] = hn::Sub(c.y[to], c.y[from]);
  // An edge owns its points if dy < 0, or dy = 0 and dx > 0: the sign of one number, since |dx| < 2^15.
  const VI order = hn::Sub(hn::ShiftLeft<15>(t.dy[k]), t.dx[k]);
  t.bias[k] = rule == EdgeRule::TopLeft ? hn::Not(hn::BroadcastSignBit(order)) : hn::Zero(i32);
}

HWY_INLINE void set_up_edges(const Corners& c, EdgeRule rule, SetUp& t) {
  set_up_edge<0>(c, rule, t);
  set_up_edge<1>(c, rule, t);
  set_up_edge<2>(c, rule, t);
}

/// The other values, which need only the edge from vertex 0 to 1.
HWY_INLINE void set_up_plane(const Corners& c, VI low_x, VI low_y, SetUp& t) {
  t.area = hn::Sub(hn::Mul(t.dx[2], hn::Sub(c.y[2], c.y[0])), hn::Mul(t.dy[2], hn::Sub(c.x[2], c.x[0])));
  t.origin_x = hn::ShiftRight<8>(low_x);
  t.origin_y = hn::ShiftRight<8>(low_y);
  set_up_depth<0>(c, t);
  set_up_depth<1>(c, t);
  const VD pixel = hn::Set(f64, 256.0);
  t.step_x = narrowed(hn::Mul(t.dzdx[0], pixel), hn::Mul(t.dzdx[1], pixel));
  t.step_y = narrowed(hn::Mul(t.dzdy[0], pixel), hn::Mul(t.dzdy[1], pixel));
  t.z_low = hn::Min(hn::Min(c.z[0], c.z[1]), c.z[2]);
  t.z_high = hn::Max(hn::Max(c.z[0], c.z[1]), c.z[2]);
}

HWY_INLINE void set_up(const Corners& c, const Extent& e, EdgeRule rule, SetUp& t) {
  set_up_edges(c, rule, t);
  set_up_plane(c, e.low_x, e.low_y, t);
}

/// The members of a vector of Triangles, structure of arrays.
struct RecordLanes {
  alignas(64) std::int32_t a[3][lanes], b[3][lanes], bias[3][lanes];
  alignas(64) std::int64_t c[3][lanes];  ///< without the bias; the even lanes, then the odd ones
  alignas(64) std::int32_t min_x[lanes], min_y[lanes], max_x[lanes], max_y[lanes], x0[lanes], y0[lanes], id[lanes];
  alignas(64) double z0[lanes], dzdx[lanes], dzdy[lanes];
  alignas(64) float z_low[lanes], z_high[lanes];

  static HWY_INLINE VI odd(VI v) {
    const hn::Repartition<std::int64_t, DI> i64;
    return hn::BitCast(i32, hn::ShiftRight<32>(hn::BitCast(i64, v)));
  }

  /// The products of the even lanes. Highway 1.0.3 ignores their signs on WebAssembly.
  static HWY_INLINE hn::Vec<hn::Repartition<std::int64_t, DI>> products(VI p, VI q) {
#if HWY_TARGET == HWY_WASM
    const auto even = [](VI v) { return wasm_i64x2_shr(wasm_i64x2_shl(v.raw, 32), 32); };
    return {wasm_i64x2_mul(even(p), even(q))};
#else
    return hn::MulEven(p, q);
#endif
  }

  template <int k>
  HWY_INLINE void store_edge(const Corners& corners, const SetUp& t) {
    constexpr int from = (k + 1) % 3;
    const hn::Repartition<std::int64_t, DI> i64;
    const VI dx = t.dx[k], dy = t.dy[k], x = corners.x[from], y = corners.y[from];
    hn::Store(hn::Neg(dy), i32, a[k]);
    hn::Store(dx, i32, b[k]);
    hn::Store(t.bias[k], i32, bias[k]);
    hn::Store(hn::Sub(products(dy, x), products(dx, y)), i64, c[k]);
    hn::Store(hn::Sub(products(odd(dy), odd(x)), products(odd(dx), odd(y))), i64, c[k] + lanes / 2);
  }

  HWY_INLINE void store_rest(const Corners& corners, const Extent& e, const SetUp& t) {
    hn::Store(t.origin_x, i32, min_x);
    hn::Store(t.origin_y, i32, min_y);
    hn::Store(hn::ShiftRight<8>(e.high_x), i32, max_x);
    hn::Store(hn::ShiftRight<8>(e.high_y), i32, max_y);
    hn::Store(corners.x[0], i32, x0);
    hn::Store(corners.y[0], i32, y0);
    hn::Store(corners.id, i32, id);
    store_halves(t.z0, z0);
    store_halves(t.dzdx, dzdx);
    store_halves(t.dzdy, dzdy);
    hn::Store(t.z_low, f, z_low);
    hn::Store(t.z_high, f, z_high);
  }

  static HWY_INLINE void store_halves(const VD* v, double* to) {
    hn::Store(v[0], f64, to);
    hn::Store(v[1], f64, to + lanes / 2);
  }

  HWY_INLINE void copy(int lane, Triangle& t) const {
    const int at = (lane & 1) * (lanes / 2) + lane / 2;
    for (int k = 0; k < 3; ++k) {
      t.a[k] = a[k][lane], t.b[k] = b[k][lane];
      t.c[k] = c[k][at] + bias[k][lane];
    }
    t.min_x = min_x[lane], t.min_y = min_y[lane], t.max_x = max_x[lane], t.max_y = max_y[lane];
    t.x0 = x0[lane], t.y0 = y0[lane];
    t.z0 = z0[lane], t.dzdx = dzdx[lane], t.dzdy = dzdy[lane];
    t.z_low = z_low[lane], t.z_high = z_high[lane];
    t.id = id[lane];
  }
};

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
