// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/raster/geometry/project.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// One row of the matrix times (x, y, z, 1), in the order of operator*.
template <class V, class D>
HWY_INLINE V row(D d, float a, float b, float c, float e, V x, V y, V z) {
  return hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(d, a), x), hn::Mul(hn::Set(d, b), y)), hn::Mul(hn::Set(d, c), z)),
                 hn::Set(d, e));
}

template <class D>
HWY_INLINE void project_lanes(D d, const float4x4& m, const float* p, Viewport viewport, float* out) {
  using V = hn::Vec<D>;
  V px, py, pz;
  hn::LoadInterleaved3(d, p, px, py, pz);
  const float4 *c0 = &m.column[0], *c1 = &m.column[1], *c2 = &m.column[2], *c3 = &m.column[3];
  const V x = row(d, c0->x, c1->x, c2->x, c3->x, px, py, pz);
  const V y = row(d, c0->y, c1->y, c2->y, c3->y, px, py, pz);
  const V z = row(d, c0->z, c1->z, c2->z, c3->z, px, py, pz);
  const V w = row(d, c0->w, c1->w, c2->w, c3->w, px, py, pz);

  const V sx = hn::Mul(hn::Div(x, w), hn::Set(d, static_cast<float>(viewport.width * 128)));
  const V sy = hn::Mul(hn::Div(y, w), hn::Set(d, static_cast<float>(viewport.height * -128)));
  const V zero = hn::Zero(d), limit = hn::Set(d, static_cast<float>(guard_band));
  const auto inside = hn::And(hn::And(hn::Gt(w, zero), hn::And(hn::Ge(z, zero), hn::Le(z, w))),
                              hn::And(hn::Le(hn::Abs(sx), limit), hn::Le(hn::Abs(sy), limit)));
  const auto snap = [&](V v) { return hn::BitCast(d, hn::NearestInt(hn::IfThenElseZero(inside, v))); };
  hn::StoreInterleaved4(snap(sx), snap(sy), hn::IfThenElseZero(inside, hn::Add(hn::Div(z, w), zero)),
                        hn::IfThenElseZero(inside, hn::Div(hn::Set(d, 1.0f), w)), d, out);
}

void transform(const float4x4& m, const float3* p, std::size_t n, Viewport viewport, ScreenVertex* out) {
  const hn::CappedTag<float, 16> wide;
  const std::size_t lanes = hn::Lanes(wide);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) project_lanes(wide, m, &p[i].x, viewport, reinterpret_cast<float*>(out + i));

  // The last vertices are copied into an array of a whole vector.
  if (i == n) return;
  alignas(64) float in[3 * HWY_MAX_BYTES / sizeof(float)] = {};
  alignas(64) float result[4 * HWY_MAX_BYTES / sizeof(float)];
  for (std::size_t k = i; k < n; ++k) {
    in[3 * (k - i)] = p[k].x;
    in[3 * (k - i) + 1] = p[k].y;
    in[3 * (k - i) + 2] = p[k].z;
  }
  project_lanes(wide, m, in, viewport, result);
  __builtin_memcpy(static_cast<void*>(out + i), result, (n - i) * sizeof(ScreenVertex));
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const ProjectKernels PerIsa<ProjectKernels>::HWY_NAMESPACE = {.transform = HWY_NAMESPACE::transform};
}  // namespace zoneplate
