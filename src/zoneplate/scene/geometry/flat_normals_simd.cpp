// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/math/halves_simd.h"
#include "zoneplate/scene/geometry/flat_normals.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

#if HWY_HAVE_FLOAT64

using D = hn::CappedTag<double, 4>;
using V = hn::Vec<D>;
constexpr D d;
constexpr hn::CappedTag<float, 4> four;
constexpr hn::CappedTag<std::uint8_t, 16> bytes;
using Row = hn::Vec<decltype(four)>;
constexpr std::size_t group = 4;  ///< triangles in a group

/// One double per triangle of a group.
struct Number {
  static constexpr std::size_t parts = group * sizeof(double) / sizeof(V);
  V part[parts];
};

template <class R>
HWY_INLINE Number widened(R row) {
  const hn::Rebind<float, D> narrow;
  if constexpr (Number::parts == 1)
    return {{hn::PromoteTo(d, row)}};
  else
    return {{hn::PromoteTo(d, hn::LowerHalf(narrow, row)), hn::PromoteTo(d, hn::UpperHalf(narrow, row))}};
}
template <class N>
HWY_INLINE Row narrowed(const N& n) {
  const hn::Rebind<float, D> narrow;
  if constexpr (Number::parts == 1)
    return hn::DemoteTo(narrow, n.part[0]);
  else
    return hn::Combine(four, hn::DemoteTo(narrow, n.part[1]), hn::DemoteTo(narrow, n.part[0]));
}

struct Rows {
  Row x, y, z;
};

/// One corner of each triangle of a group. The bytes after it are read too.
HWY_INLINE Rows corner(const std::uint8_t* corners, std::size_t stride) {
  const auto row = [&](std::size_t i) { return hn::BitCast(four, hn::LoadU(bytes, corners + i * stride)); };
  const Row a = row(0), b = row(1), c = row(2), e = row(3);
  const Row low_even = hn::InterleaveLower(four, a, c), low_odd = hn::InterleaveLower(four, b, e);
  return {hn::InterleaveLower(four, low_even, low_odd), hn::InterleaveUpper(four, low_even, low_odd),
          hn::InterleaveLower(four, hn::InterleaveUpper(four, a, c), hn::InterleaveUpper(four, b, e))};
}

struct Edge {
  Number x, y, z;
};
HWY_INLINE Number difference(Row from, Row to) {
  const Number a = widened(from), b = widened(to);
  Number out;
  for (std::size_t k = 0; k < Number::parts; ++k) out.part[k] = hn::Sub(b.part[k], a.part[k]);
  return out;
}
HWY_INLINE Edge edge(const Rows& from, const Rows& to) {
  return {difference(from.x, to.x), difference(from.y, to.y), difference(from.z, to.z)};
}

HWY_INLINE V minor(V a, V b, V c, V e) { return hn::Sub(hn::Mul(a, b), hn::Mul(c, e)); }

/// The normals of a group.
HWY_INLINE Rows normals(const std::uint8_t* corners, std::size_t stride) {
  const Rows a = corner(corners, stride);
  const Edge u = edge(a, corner(corners + 12, stride)), v = edge(a, corner(corners + 24, stride));
  Edge n;
  for (std::size_t k = 0; k < Number::parts; ++k) {
    const V x = minor(u.y.part[k], v.z.part[k], u.z.part[k], v.y.part[k]);
    const V y = minor(u.z.part[k], v.x.part[k], u.x.part[k], v.z.part[k]);
    const V z = minor(u.x.part[k], v.y.part[k], u.y.part[k], v.x.part[k]);
    const V square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const auto is_sound = hn::And(hn::Gt(square, hn::Zero(d)), hn::Lt(square, hn::Set(d, 1e300)));
    const V scale = hn::Div(hn::Set(d, 1), hn::Sqrt(square));
    n.x.part[k] = hn::IfThenElseZero(is_sound, hn::Mul(x, scale));
    n.y.part[k] = hn::IfThenElse(is_sound, hn::Mul(y, scale), hn::Set(d, 1));
    n.z.part[k] = hn::IfThenElseZero(is_sound, hn::Mul(z, scale));
  }
  return {narrowed(n.x), narrowed(n.y), narrowed(n.z)};
}

/// Writes a triangle's normal three times, and one more float.
HWY_INLINE void put(Row row, float* normal) {
  for (std::size_t k = 0; k < 9; k += 3) hn::StoreU(row, four, normal + k);
}

void make(const std::uint8_t* corners, std::size_t stride, std::size_t triangles, float* normal) {
  std::size_t i = 0;
  for (; i + group < triangles; i += group) {
    const Rows n = normals(corners + i * stride, stride);
    const Row xz_low = hn::InterleaveLower(four, n.x, n.z), xz_high = hn::InterleaveUpper(four, n.x, n.z);
    const Row y_low = hn::InterleaveLower(four, n.y, n.y), y_high = hn::InterleaveUpper(four, n.y, n.y);
    float* const out = normal + 9 * i;
    put(hn::InterleaveLower(four, xz_low, y_low), out);
    put(hn::InterleaveUpper(four, xz_low, y_low), out + 9);
    put(hn::InterleaveLower(four, xz_high, y_high), out + 18);
    put(hn::InterleaveUpper(four, xz_high, y_high), out + 27);
  }
  // The scalar version processes the last triangles, because it does not access memory beyond their corners and
  // normals.
  FlatNormalKernels::scalar.make(corners + i * stride, stride, triangles - i, normal + 9 * i);
}

#else

/// Highway has no vectors of double for this instruction set.
void make(const std::uint8_t* corners, std::size_t stride, std::size_t triangles, float* normal) {
  FlatNormalKernels::scalar.make(corners, stride, triangles, normal);
}

#endif

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const FlatNormalKernels PerIsa<FlatNormalKernels>::HWY_NAMESPACE = {.make = HWY_NAMESPACE::make};
}  // namespace zoneplate
