// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/math/halves_simd.h"
#include "zoneplate/math/wasm_double_simd.h"
#include "zoneplate/raster/fragment/interpolate.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using DF = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;

template <class D>
constexpr int lanes_of = static_cast<int>(hn::MaxLanes(D()));
template <class D>
using IntsOf = hn::Vec<hn::RebindToSigned<D>>;
constexpr int lanes = lanes_of<DF>;

/// As many doubles as a vector has floats: in two vectors, or in one if it has enough lanes.
template <class D>
struct DoublesOf {
  using Doubles = DoublesOf;
  using DD = hn::CappedTag<double, hn::MaxLanes(D())>;
  static constexpr int size = lanes_of<DD>, parts = lanes_of<D> / size;
  hn::Vec<DD> v[parts];

  template <class Make>
  static HWY_INLINE Doubles make(Make part) {
    Doubles out;
    for (int p = 0; p < parts; ++p) out.v[p] = part(p);
    return out;
  }
  static HWY_INLINE Doubles all(double x) {
    return make([&](int) HWY_ATTR { return hn::Set(DD(), x); });
  }
  /// 0, 1, 2 ...
  static HWY_INLINE Doubles steps() {
    return make([&](int p) HWY_ATTR { return hn::Iota(DD(), p * size); });
  }
  static HWY_INLINE Doubles load(const double* from) {
    return make([&](int p) HWY_ATTR { return hn::Load(DD(), from + p * size); });
  }
  HWY_INLINE void store(double* to) const {
    for (int p = 0; p < parts; ++p) hn::Store(v[p], DD(), to + p * size);
  }
  static HWY_INLINE Doubles of(IntsOf<D> x) {
    if constexpr (parts == 1) {
      return {{hn::PromoteTo(DD(), x)}};
    } else {
      const hn::Half<hn::RebindToSigned<D>> half;
      return {{hn::PromoteTo(DD(), hn::LowerHalf(half, x)), hn::PromoteTo(DD(), hn::UpperHalf(half, x))}};
    }
  }
  HWY_INLINE hn::Vec<D> to_floats() const {
    if constexpr (parts == 1) {
      return hn::DemoteTo(D(), v[0]);
    } else {
      const hn::Half<D> half;
      return combined(D(), hn::DemoteTo(half, v[1]), hn::DemoteTo(half, v[0]));
    }
  }
  friend HWY_INLINE Doubles operator+(const Doubles& a, const Doubles& b) {
    return make([&](int p) HWY_ATTR { return hn::Add(a.v[p], b.v[p]); });
  }
  friend HWY_INLINE Doubles operator-(const Doubles& a, const Doubles& b) {
    return make([&](int p) HWY_ATTR { return hn::Sub(a.v[p], b.v[p]); });
  }
  friend HWY_INLINE Doubles operator*(const Doubles& a, const Doubles& b) {
    return make([&](int p) HWY_ATTR { return hn::Mul(a.v[p], b.v[p]); });
  }
};

using Doubles = DoublesOf<DF>;

/// Vertex k of the triangles of several fragments.
template <class D>
struct Corner {
  IntsOf<D> x, y;
  hn::Vec<D> inv_w;
};

/// Vertex k by address.
struct ByAddress {
  const ScreenVertex* const* v;
  HWY_INLINE const ScreenVertex* operator[](int i) const { return v[i]; }
};
/// Vertex k by index.
struct ByNumber {
  const ScreenVertex* screen;
  const std::uint32_t* v;
  HWY_INLINE const ScreenVertex* operator[](int i) const { return screen + v[i]; }
};

template <class D, class Vertices>
HWY_INLINE Corner<D> turned_corners(const Vertices& v) {
  const hn::RebindToSigned<D> d;
  static_assert(sizeof(ScreenVertex) == 16);
  const auto vertex = [&](int i) HWY_ATTR {
    return hn::LoadU(hn::FixedTag<std::int32_t, 4>(), reinterpret_cast<const std::int32_t*>(v[i]));
  };
  const auto v0 = every_fourth_quad(d, vertex, 0), v1 = every_fourth_quad(d, vertex, 1);
  const auto v2 = every_fourth_quad(d, vertex, 2), v3 = every_fourth_quad(d, vertex, 3);
  const auto xz01 = hn::InterleaveLower(d, v0, v2), xz23 = hn::InterleaveLower(d, v1, v3);
  const auto zw01 = hn::InterleaveUpper(d, v0, v2), zw23 = hn::InterleaveUpper(d, v1, v3);
  return {hn::InterleaveLower(d, xz01, xz23), hn::InterleaveUpper(d, xz01, xz23),
          hn::BitCast(D(), hn::InterleaveUpper(d, zw01, zw23))};
}

/// The edge functions at fragments, and their sum or a value with its sign.
template <class D>
struct Edges {
  hn::Vec<D> e[3], sum;
};

template <class D>
HWY_INLINE Edges<D> near_edges_at(const IntsOf<D> (&dx)[3], const IntsOf<D> (&dy)[3]) {
  const D d;
  const hn::Vec<D> x[3] = {hn::ConvertTo(d, dx[0]), hn::ConvertTo(d, dx[1]), hn::ConvertTo(d, dx[2])};
  const hn::Vec<D> y[3] = {hn::ConvertTo(d, dy[0]), hn::ConvertTo(d, dy[1]), hn::ConvertTo(d, dy[2])};
  Edges<D> out;
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3, n = (k + 2) % 3;
    out.e[k] = hn::Sub(hn::Mul(x[m], y[n]), hn::Mul(y[m], x[n]));
  }
  out.sum = hn::Add(hn::Add(out.e[0], out.e[1]), out.e[2]);
  return out;
}

template <class D>
HWY_INLINE Edges<D> edges_at(const IntsOf<D> (&dx)[3], const IntsOf<D> (&dy)[3]) {
  // For vertices less than 8 pixels from the fragment, floats hold the products and their sums exactly.
  const hn::RebindToSigned<D> di;
  const auto beyond = [&](IntsOf<D> v) HWY_ATTR { return hn::ShiftRight<11>(hn::Xor(v, hn::BroadcastSignBit(v))); };
  const auto far_x = hn::Or(hn::Or(beyond(dx[0]), beyond(dx[1])), beyond(dx[2]));
  const auto far_y = hn::Or(hn::Or(beyond(dy[0]), beyond(dy[1])), beyond(dy[2]));
  if (hn::AllTrue(di, hn::Eq(hn::Or(far_x, far_y), hn::Zero(di)))) return near_edges_at<D>(dx, dy);
  using Many = DoublesOf<D>;
  const Many x[3] = {Many::of(dx[0]), Many::of(dx[1]), Many::of(dx[2])};
  const Many y[3] = {Many::of(dy[0]), Many::of(dy[1]), Many::of(dy[2])};
  const auto edge = [&](int m, int n) HWY_ATTR { return x[m] * y[n] - y[m] * x[n]; };
  const Many e[3] = {edge(1, 2), edge(2, 0), edge(0, 1)};
  return {{e[0].to_floats(), e[1].to_floats(), e[2].to_floats()}, (e[0] + e[1] + e[2]).to_floats()};
}

template <class V>
HWY_INLINE V clamped(V b, V limit) {
  const hn::DFromV<V> d;
  return hn::Add(hn::Min(hn::Max(b, hn::Zero(d)), limit), hn::Zero(d));
}

/// is_front of triangles whose edge functions have these sums.
template <class D>
HWY_INLINE void store_front(const Edges<D>& e, const std::int32_t* is_mirrored, std::int32_t* out) {
  // The sign of the sum survives the rounding to float.
  const D d;
  const hn::RebindToSigned<D> di;
  const auto is_clockwise = hn::Gt(e.sum, hn::Zero(d));
  const auto clockwise = hn::IfThenElseZero(hn::RebindMask(di, is_clockwise), hn::Set(di, 1));
  const auto is_front = hn::Eq(clockwise, hn::LoadU(di, is_mirrored));
  hn::StoreU(hn::IfThenElseZero(is_front, hn::Set(di, 1)), di, out);
}

struct Screen {
  std::int32_t centre_x, centre_y;
  float step;
  bool has_slopes;
  Screen(Viewport viewport, float spacing)
      : centre_x(viewport.width * 128),
        centre_y(viewport.height * 128),
        step(256.0f * spacing),
        has_slopes(spacing != 0) {}

  /// The positions of the batch's fragments, relative to the image's centre.
  template <class DI>
  HWY_INLINE hn::Vec<DI> x(DI d, const std::int32_t* from) const {
    return hn::Sub(hn::LoadU(d, from), hn::Set(d, centre_x));
  }
  template <class DI>
  HWY_INLINE hn::Vec<DI> y(DI d, const std::int32_t* from) const {
    return hn::Sub(hn::LoadU(d, from), hn::Set(d, centre_y));
  }
};

/// The weights of fragments, from their edge functions.
template <class V>
struct Weights {
  V b1, b2, inverse;
};

template <class V>
HWY_INLINE Weights<V> store_weights(V q1, V q2, V inverse, float* b1_out, float* b2_out) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const V b1 = clamped(hn::Mul(q1, inverse), one), b2 = clamped(hn::Mul(q2, inverse), hn::Sub(one, b1));
  hn::StoreU(b1, d, b1_out);
  hn::StoreU(b2, d, b2_out);
  return {b1, b2, inverse};
}

template <class V>
HWY_INLINE V inverse_of(V sum) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  return hn::Div(one, hn::IfThenElse(hn::Eq(sum, hn::Zero(d)), one, sum));
}

/// The derivatives of q_1, q_2 and of the sum of all three.
template <class V>
HWY_INLINE void store_slopes(const Weights<V>& w, V by, V g1, V g2, V all, float* out1, float* out2) {
  const hn::DFromV<V> d;
  hn::StoreU(hn::Mul(hn::Sub(g1, hn::Mul(w.b1, all)), by), d, out1);
  hn::StoreU(hn::Mul(hn::Sub(g2, hn::Mul(w.b2, all)), by), d, out2);
}

/// Interpolates a vector of fragments of several triangles, from i on; true if one of the triangles needs clipping.
template <class D>
HWY_INLINE bool interpolate_at(const Corner<D> (&c)[3], const Screen& screen, const BatchTriangles& triangles,
                               FragmentBatch& batch, int i) {
  using V = hn::Vec<D>;
  using Ints = IntsOf<D>;
  const D d;
  const hn::RebindToSigned<D> di;
  const Ints px = screen.x(di, batch.x + i), py = screen.y(di, batch.y + i);
  const Ints dx[3] = {hn::Sub(c[0].x, px), hn::Sub(c[1].x, px), hn::Sub(c[2].x, px)};
  const Ints dy[3] = {hn::Sub(c[0].y, py), hn::Sub(c[1].y, py), hn::Sub(c[2].y, py)};
  const Edges<D> edges = edges_at<D>(dx, dy);
  store_front(edges, triangles.is_mirrored + i, batch.is_front + i);
  V inv_w[3] = {c[0].inv_w, c[1].inv_w, c[2].inv_w};
  const auto is_affine = hn::And(hn::Eq(inv_w[0], inv_w[1]), hn::Eq(inv_w[1], inv_w[2]));
  const bool has_affine = !hn::AllFalse(d, is_affine);
  if (has_affine)
    for (V& v : inv_w) v = hn::IfThenElse(is_affine, hn::Set(d, 1.0f), v);
  const V q[3] = {hn::Mul(edges.e[0], inv_w[0]), hn::Mul(edges.e[1], inv_w[1]), hn::Mul(edges.e[2], inv_w[2])};
  V sum = hn::Add(hn::Add(q[0], q[1]), q[2]);
  if (has_affine) sum = hn::IfThenElse(is_affine, edges.sum, sum);
  const Weights<V> w = store_weights(q[1], q[2], inverse_of(sum), batch.b[0] + i, batch.b[1] + i);
  if (screen.has_slopes) {
    const auto derivative = [&](const Ints(&at)[3], int m, int n, int k)
                                HWY_ATTR { return hn::Mul(hn::ConvertTo(d, hn::Sub(at[m], at[n])), inv_w[k]); };
    const auto store = [&](V g0, V g1, V g2, float(&out)[2][FragmentBatch::padded_capacity]) HWY_ATTR {
      V all = hn::Add(hn::Add(g0, g1), g2);
      if (has_affine) all = hn::IfThenZeroElse(is_affine, all);
      store_slopes(w, hn::Mul(w.inverse, hn::Set(d, screen.step)), g1, g2, all, out[0] + i, out[1] + i);
    };
    store(derivative(dy, 1, 2, 0), derivative(dy, 2, 0, 1), derivative(dy, 0, 1, 2), batch.dbdx);
    store(derivative(dx, 2, 1, 0), derivative(dx, 0, 2, 1), derivative(dx, 1, 0, 2), batch.dbdy);
  }
  const V least = hn::Min(hn::Min(c[0].inv_w, c[1].inv_w), c[2].inv_w);
  return !hn::AllTrue(d, hn::Gt(least, hn::Zero(d)));
}

/// The constants of a run's triangle: E_k = a_k x + (b_k y + c_k), all terms exact, and the derivatives of q_k.
struct RowTriangle {
  alignas(32) double a[4] = {}, b[4] = {}, c[4] = {};  ///< the fourth ones are unused
  alignas(64) double way[3][FragmentBatch::group];     ///< a_k × the distance of each pixel from the group's first
  float inv_w[3] = {}, gx[3] = {}, gy[3] = {}, sum_x = 0, sum_y = 0;
  float inverse = 0;  ///< 1 / the sum of the E_k, of an affine triangle
  std::int32_t is_clockwise = 0;
  bool needs_clipping = false, is_affine = false;

  HWY_INLINE void make(const BatchTriangles& triangles, int i) {
    const ScreenVertex* const vertex[3] = {triangles.vertex[0][i], triangles.vertex[1][i], triangles.vertex[2][i]};
    needs_clipping = false;
    for (int k = 0; k < 3; ++k) {
      inv_w[k] = vertex[k]->inv_w;
      needs_clipping = needs_clipping || inv_w[k] == 0;
    }
    is_affine = !needs_clipping && inv_w[0] == inv_w[1] && inv_w[1] == inv_w[2];
    if (is_affine) inv_w[0] = inv_w[1] = inv_w[2] = 1;
    for (int k = 0; k < 3; ++k) {
      const ScreenVertex &m = *vertex[(k + 1) % 3], &n = *vertex[(k + 2) % 3];
      a[k] = static_cast<double>(m.y - n.y);
      b[k] = static_cast<double>(n.x - m.x);
      c[k] = static_cast<double>(m.x) * static_cast<double>(n.y) - static_cast<double>(m.y) * static_cast<double>(n.x);
      gx[k] = static_cast<float>(m.y - n.y) * inv_w[k];
      gy[k] = static_cast<float>(n.x - m.x) * inv_w[k];
      for (int at = 0; at < FragmentBatch::group; at += lanes)
        (Doubles::all(a[k]) * ((Doubles::steps() + Doubles::all(at)) * Doubles::all(256))).store(way[k] + at);
    }
    const double area = (c[0] + c[1]) + c[2];
    is_clockwise = area > 0 ? 1 : 0;
    sum_x = is_affine ? 0 : (gx[0] + gx[1]) + gx[2];
    sum_y = is_affine ? 0 : (gy[0] + gy[1]) + gy[2];
    inverse = 1.0f / (area == 0 ? 1.0f : static_cast<float>(area));
  }
};

/// The edge functions at the fragments of a run's groups, from `first` on.
class EdgesOfRow {
 public:
  HWY_INLINE EdgesOfRow(const RowTriangle& t, Viewport viewport, const FragmentBatch& batch, int first, int last)
      : triangle_(t) {
    const Three a = Three::load(t.a), b = Three::load(t.b), c = Three::load(t.c);
    for (int i = first; i < last; i += FragmentBatch::group) {
      const double px = batch.x[i] - viewport.width * 128, py = batch.y[i] - viewport.height * 128;
      (a * Three::all(px) + (b * Three::all(py) + c))
          .store(at_first_[static_cast<std::size_t>(i) / FragmentBatch::group]);
    }
  }
  /// Edge function k at the fragments from i on of the group that begins at `group`.
  HWY_INLINE VF at(int k, int group, int i) const {
    const double at_first = at_first_[static_cast<std::size_t>(group) / FragmentBatch::group][k];
    return (Doubles::all(at_first) + Doubles::load(triangle_.way[k] + (i - group))).to_floats();
  }

 private:
  using Three = DoublesOf<hn::CappedTag<float, 4>>;
  const RowTriangle& triangle_;
  /// By group of the batch: the edge functions at its first fragment.
  alignas(64) double at_first_[FragmentBatch::groups][4];
};

/// Interpolates the groups from `first` to `last` of an affine triangle.
HWY_INLINE void interpolate_affine_run(const RowTriangle& t, const Screen& screen, Viewport viewport,
                                       FragmentBatch& batch, int first, int last) {
  const DF d;
  const VF inverse = hn::Set(d, t.inverse), by = hn::Mul(inverse, hn::Set(DF(), screen.step));
  const auto derivative = [&](float g) HWY_ATTR { return hn::Mul(hn::Set(d, g), by); };
  const VF dx1 = derivative(t.gx[1]), dx2 = derivative(t.gx[2]), dy1 = derivative(t.gy[1]), dy2 = derivative(t.gy[2]);
  const EdgesOfRow edges(t, viewport, batch, first, last);
  for (int group = first; group < last; group += FragmentBatch::group)
    for (int i = group; i < group + FragmentBatch::group; i += lanes) {
      store_weights(edges.at(1, group, i), edges.at(2, group, i), inverse, batch.b[0] + i, batch.b[1] + i);
      if (!screen.has_slopes) continue;
      hn::Store(dx1, d, batch.dbdx[0] + i), hn::Store(dx2, d, batch.dbdx[1] + i);
      hn::Store(dy1, d, batch.dbdy[0] + i), hn::Store(dy2, d, batch.dbdy[1] + i);
    }
}

/// The derivatives of q_1, q_2 and of the sum of all three, the same for all fragments.
struct RunSlopes {
  float gx[2], gy[2], all_x, all_y;
};

/// Finishes whole vectors of fragments in [i, last) from q_1 and q_2, which are stored in b, and their sum. Returns the
/// fragment after them.
template <class DD>
HWY_INLINE int finish_vectors(DD d, const RunSlopes& t, const Screen& screen, const float* sum, FragmentBatch& batch,
                              int i, int last) {
  using V = hn::Vec<DD>;
  constexpr int size = static_cast<int>(hn::MaxLanes(DD()));
  const auto same = [&](float x) HWY_ATTR { return hn::Set(d, x); };
  const V gx0 = same(t.gx[0]), gx1 = same(t.gx[1]), all_x = same(t.all_x);
  const V gy0 = same(t.gy[0]), gy1 = same(t.gy[1]), all_y = same(t.all_y), step = same(screen.step);
  const bool has_slopes = screen.has_slopes;
  for (; i + size <= last; i += size) {
    float *const b1 = batch.b[0] + i, *const b2 = batch.b[1] + i;
    const Weights<V> w = store_weights(hn::LoadU(d, b1), hn::LoadU(d, b2), inverse_of(hn::LoadU(d, sum + i)), b1, b2);
    if (!has_slopes) continue;
    const V by = hn::Mul(w.inverse, step);
    store_slopes(w, by, gx0, gx1, all_x, batch.dbdx[0] + i, batch.dbdx[1] + i);
    store_slopes(w, by, gy0, gy1, all_y, batch.dbdy[0] + i, batch.dbdy[1] + i);
  }
  return i;
}

/// Finishes the fragments [first, last).
HWY_INLINE void finish_run(const RunSlopes& t, const Screen& screen, const float* sum, FragmentBatch& batch, int first,
                           int last) {
  const DF d;
  const hn::CappedTag<float, 16> wide;
  // Vectors of two groups begin at every second group.
  constexpr int step = static_cast<int>(hn::MaxLanes(wide));
  int i = first;
  if (first % step != 0) i = finish_vectors(d, t, screen, sum, batch, i, first + FragmentBatch::group);
  i = finish_vectors(wide, t, screen, sum, batch, i, last);
  if (i < last) finish_vectors(d, t, screen, sum, batch, i, last);
}

/// Interpolates the groups of a perspective triangle. In two loops, because both computations are long dependency
/// chains.
HWY_INLINE void interpolate_run(const RowTriangle& t, const Screen& screen, Viewport viewport, FragmentBatch& batch,
                                int first, int last) {
  const DF d;
  const auto same = [&](float x) HWY_ATTR { return hn::Set(d, x); };
  alignas(64) float sum[FragmentBatch::padded_capacity];
  const EdgesOfRow edges(t, viewport, batch, first, last);
  for (int group = first; group < last; group += FragmentBatch::group)
    for (int i = group; i < group + FragmentBatch::group; i += lanes) {
      VF q[3];
      for (int k = 0; k < 3; ++k) q[k] = hn::Mul(edges.at(k, group, i), same(t.inv_w[k]));
      hn::Store(q[1], d, batch.b[0] + i), hn::Store(q[2], d, batch.b[1] + i);
      hn::Store(hn::Add(hn::Add(q[0], q[1]), q[2]), d, sum + i);
    }
  finish_run({{t.gx[1], t.gx[2]}, {t.gy[1], t.gy[2]}, t.sum_x, t.sum_y}, screen, sum, batch, first, last);
}

/// Fills x and y of all fragments from those of each group's first fragment.
HWY_INLINE void spread_places(FragmentBatch& batch, int first, int last) {
  const DI d;
  const VI steps = hn::Mul(hn::Iota(d, 0), hn::Set(d, 256));
  for (int group = first; group < last; group += FragmentBatch::group) {
    const std::int32_t x = batch.x[group], y = batch.y[group];
    for (int i = group; i < group + FragmentBatch::group; i += lanes) {
      hn::Store(hn::Add(hn::Set(d, x + (i - group) * 256), steps), d, batch.x + i);
      hn::Store(hn::Set(d, y), d, batch.y + i);
    }
  }
}

/// Interpolates the groups from `first` to `last`, of one triangle; true if it needs clipping.
bool interpolate_rows(const BatchTriangles& triangles, const Screen& screen, Viewport viewport, FragmentBatch& batch,
                      int first, int last) {
  RowTriangle t;
  t.make(triangles, first);
  batch.is_front[first] = t.is_clockwise == triangles.is_mirrored[first] ? 1 : 0;
  if (t.is_affine) {
    interpolate_affine_run(t, screen, viewport, batch, first, last);
  } else if (!t.needs_clipping) {
    interpolate_run(t, screen, viewport, batch, first, last);
  }
  batch.has_uniform_derivatives[first / FragmentBatch::group] = false;
  for (int g = first / FragmentBatch::group + 1; g < last / FragmentBatch::group; ++g)
    batch.has_uniform_derivatives[g] = t.is_affine;
  spread_places(batch, first, last);
  return t.needs_clipping;
}

/// Interpolates vectors of fragments of several triangles; true if one of the triangles needs clipping.
template <class D>
HWY_INLINE bool interpolate_vectors(const BatchTriangles& triangles, const Screen& screen, FragmentBatch& batch,
                                    int first, int last) {
  bool is_clipped = false;
  for (int i = first; i < last; i += lanes_of<D>) {
    Corner<D> c[3];
    for (int k = 0; k < 3; ++k)
      c[k] = triangles.screen ? turned_corners<D>(ByNumber{triangles.screen, batch.vertex[k] + i})
                              : turned_corners<D>(ByAddress{triangles.vertex[k] + i});
    is_clipped = interpolate_at<D>(c, screen, triangles, batch, i) || is_clipped;
  }
  return is_clipped;
}

/// The same for the groups from `first` to `last`: as many groups as a vector has, or one.
bool interpolate_fragments(const BatchTriangles& triangles, const Screen& screen, FragmentBatch& batch, int first,
                           int last) {
  for (int g = first; g < last; ++g) batch.has_uniform_derivatives[g] = false;
  using Wide = hn::CappedTag<float, 16>;
  const int begin = first * FragmentBatch::group, end = last * FragmentBatch::group;
  if (lanes_of < Wide >> FragmentBatch::group && end - begin == lanes_of<Wide>)
    return interpolate_vectors<Wide>(triangles, screen, batch, begin, end);
  return interpolate_vectors<DF>(triangles, screen, batch, begin, end);
}

std::uint32_t interpolate(const BatchTriangles& triangles, Viewport viewport, float spacing, FragmentBatch& batch) {
  const Screen screen(viewport, spacing);
  std::uint32_t clipped = 0;
  const int groups = batch.padded() / FragmentBatch::group;
  for (int first = 0, g; first < groups; first = g) {
    g = batch.next_run(first);
    bool is_clipped;
    if (batch.is_flat_run[first]) {
      is_clipped =
          interpolate_rows(triangles, screen, viewport, batch, first * FragmentBatch::group, g * FragmentBatch::group);
    } else {
      if (g < groups && !batch.is_flat_run[g]) ++g;
      is_clipped = interpolate_fragments(triangles, screen, batch, first, g);
    }
    if (is_clipped)
      for (int i = first; i < g; ++i) clipped |= 1u << i;
  }
  return clipped;
}

/// x px + (y py + one), rounded once, for planes of several triangles or of one.
HWY_INLINE VF plane_at(const Doubles& x, const Doubles& y, const Doubles& one, VI px, VI py) {
  return (x * Doubles::of(px) + (y * Doubles::of(py) + one)).to_floats();
}

void interpolate_clipped(Viewport viewport, float spacing, ClippedGroup& g) {
  const DI di;
  const Screen screen(viewport, spacing);
  for (int i = 0; i < FragmentBatch::group; i += lanes) {
    const VI px = screen.x(di, g.px + i), py = screen.y(di, g.py + i);
    VF q[3], gx[3], gy[3];
    for (int k = 0; k < 3; ++k) {
      const Doubles x = Doubles::load(g.x[k] + i), y = Doubles::load(g.y[k] + i);
      q[k] = plane_at(x, y, Doubles::load(g.one[k] + i), px, py);
      gx[k] = x.to_floats(), gy[k] = y.to_floats();
    }
    const VF inverse = inverse_of(hn::Add(hn::Add(q[0], q[1]), q[2]));
    const Weights<VF> w = store_weights(q[1], q[2], inverse, g.b[0] + i, g.b[1] + i);
    if (!screen.has_slopes) continue;
    const VF by = hn::Mul(inverse, hn::Set(DF(), screen.step));
    store_slopes(w, by, gx[1], gx[2], hn::Add(hn::Add(gx[0], gx[1]), gx[2]), g.dbdx[0] + i, g.dbdx[1] + i);
    store_slopes(w, by, gy[1], gy[2], hn::Add(hn::Add(gy[0], gy[1]), gy[2]), g.dbdy[0] + i, g.dbdy[1] + i);
  }
}

void interpolate_clipped_rows(const BarycentricPlanes& planes, Viewport viewport, float spacing, FragmentBatch& batch,
                              int first, int last) {
  const DF d;
  const DI di;
  const Screen screen(viewport, spacing);
  Doubles x[3], y[3], one[3];
  float gx[3], gy[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = Doubles::all(planes.x[k]), y[k] = Doubles::all(planes.y[k]), one[k] = Doubles::all(planes.one[k]);
    gx[k] = static_cast<float>(planes.x[k]), gy[k] = static_cast<float>(planes.y[k]);
  }
  alignas(64) float sum[FragmentBatch::padded_capacity];
  for (int i = first; i < last; i += lanes) {
    const VI px = screen.x(di, batch.x + i), py = screen.y(di, batch.y + i);
    VF q[3];
    for (int k = 0; k < 3; ++k) q[k] = plane_at(x[k], y[k], one[k], px, py);
    hn::Store(q[1], d, batch.b[0] + i), hn::Store(q[2], d, batch.b[1] + i);
    hn::Store(hn::Add(hn::Add(q[0], q[1]), q[2]), d, sum + i);
  }
  finish_run({{gx[1], gx[2]}, {gy[1], gy[2]}, (gx[0] + gx[1]) + gx[2], (gy[0] + gy[1]) + gy[2]}, screen, sum, batch,
             first, last);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const InterpolateKernels PerIsa<InterpolateKernels>::HWY_NAMESPACE = {
    .interpolate = HWY_NAMESPACE::interpolate,
    .interpolate_clipped = HWY_NAMESPACE::interpolate_clipped,
    .interpolate_clipped_rows = HWY_NAMESPACE::interpolate_clipped_rows};
}  // namespace zoneplate
