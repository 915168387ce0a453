#include <hwy/highway.h>

#include "zoneplate/raster/interpolate.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

void interpolate(const BatchPlanes& planes, Viewport viewport, float spacing, Batch& batch) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0), step = hn::Set(d, 256.0 * static_cast<double>(spacing));
  const auto centre_x = hn::Set(di, viewport.width * 128), centre_y = hn::Set(di, viewport.height * 128);
  const int count = batch.padded();
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const V px = hn::PromoteTo(d, hn::Sub(hn::Load(di, batch.x + i), centre_x));
    const V py = hn::PromoteTo(d, hn::Sub(hn::Load(di, batch.y + i), centre_y));
    V x[3], y[3], q[3];
    const int group = i / Batch::group;
    const bool is_shared = planes.is_shared[group];
    const BarycentricPlanes& shared = planes.shared[group];
    for (int k = 0; k < 3; ++k) {
      x[k] = is_shared ? hn::Set(d, shared.x[k]) : hn::Load(d, planes.x[k] + i);
      y[k] = is_shared ? hn::Set(d, shared.y[k]) : hn::Load(d, planes.y[k] + i);
      const V unit = is_shared ? hn::Set(d, shared.one[k]) : hn::Load(d, planes.one[k] + i);
      q[k] = hn::Add(hn::Add(hn::Mul(x[k], px), hn::Mul(y[k], py)), unit);
    }
    const V sum = hn::Add(hn::Add(q[0], q[1]), q[2]);
    const V inverse = hn::Div(one, hn::IfThenElse(hn::Eq(sum, zero), one, sum));
    const V sum_x = hn::Add(hn::Add(x[0], x[1]), x[2]), sum_y = hn::Add(hn::Add(y[0], y[1]), y[2]);
    for (int k = 0; k < 3; ++k) {
      const V b = hn::Add(hn::Min(hn::Max(hn::Mul(q[k], inverse), zero), one), zero);
      const auto slope = [&](V plane, V total) {
        return hn::DemoteTo(df, hn::Mul(hn::Mul(hn::Sub(plane, hn::Mul(b, total)), inverse), step));
      };
      hn::Store(hn::DemoteTo(df, b), df, batch.b[k] + i);
      hn::Store(slope(x[k], sum_x), df, batch.dbdx[k] + i);
      hn::Store(slope(y[k], sum_y), df, batch.dbdy[k] + i);
    }
  }
}

}  // namespace

extern const InterpolateKernels interpolate_kernels;
const InterpolateKernels interpolate_kernels = {.interpolate = interpolate};

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
