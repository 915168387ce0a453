#include "zoneplate/raster/resolve.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// Four points' channels become four pixels, a pixel a vector.
using D = hn::FixedTag<float, 4>;
using V = hn::Vec<D>;

struct FourPixels {
  V pixel[4];
};

HWY_INLINE FourPixels turned(V r, V g, V b, V a) {
  const D d;
  const V rb01 = hn::InterleaveLower(d, r, b), rb23 = hn::InterleaveUpper(d, r, b);
  const V ga01 = hn::InterleaveLower(d, g, a), ga23 = hn::InterleaveUpper(d, g, a);
  return {{hn::InterleaveLower(d, rb01, ga01), hn::InterleaveUpper(d, rb01, ga01), hn::InterleaveLower(d, rb23, ga23),
           hn::InterleaveUpper(d, rb23, ga23)}};
}

HWY_INLINE FourPixels four_at(const Shaded& color, int i) {
  const D d;
  return turned(hn::Load(d, color.r + i), hn::Load(d, color.g + i), hn::Load(d, color.b + i), hn::Load(d, color.a + i));
}

void resolve(const Shaded& color, int first, float weight, Linear* out) {
  const D d;
  const V w = hn::Set(d, weight), zero = hn::Zero(d);
  for (int i = 0; i < Batch::group; i += 4) {
    const FourPixels p = four_at(color, first + i);
    for (int k = 0; k < 4; ++k) hn::StoreU(hn::Div(hn::Add(zero, hn::Mul(p.pixel[k], w)), w), d, &out[i + k].r);
  }
}

void over(const float* color, float* behind) {
  const hn::CappedTag<float, 8> d;
  for (int i = 0; i < Batch::group; i += static_cast<int>(hn::Lanes(d))) {
    const auto rest = hn::Sub(hn::Set(d, 1.0f), hn::Load(d, color + 3 * Batch::group + i));
    for (int c = 0; c < 4; ++c) {
      float* const at = behind + c * Batch::group + i;
      hn::Store(hn::Add(hn::Load(d, color + c * Batch::group + i), hn::Mul(hn::Load(d, at), rest)), d, at);
    }
  }
}

void resolve_samples(const float* color, const float* weights, int samples, float weight_sum, Linear* out) {
  const D d;
  const V total = hn::Set(d, weight_sum);
  for (int i = 0; i < Batch::group; i += 4) {
    const FourPixels p = turned(hn::Load(d, color + i), hn::Load(d, color + Batch::group + i),
                                hn::Load(d, color + 2 * Batch::group + i), hn::Load(d, color + 3 * Batch::group + i));
    for (int k = 0; k < 4; ++k) {
      V sum = hn::Zero(d);
      for (int s = 0; s < samples; ++s) sum = hn::Add(sum, hn::Mul(p.pixel[k], hn::Set(d, weights[s])));
      hn::StoreU(hn::Div(sum, total), d, &out[i + k].r);
    }
  }
}

void add(const Shaded& color, int first, float weight, Linear* sum) {
  const D d;
  const V w = hn::Set(d, weight);
  for (int i = 0; i < Batch::group; i += 4) {
    const FourPixels p = four_at(color, first + i);
    for (int k = 0; k < 4; ++k)
      hn::StoreU(hn::Add(hn::LoadU(d, &sum[i + k].r), hn::Mul(p.pixel[k], w)), d, &sum[i + k].r);
  }
}

void divide(const Linear* sum, float weight, int n, Linear* out) {
  const D d;
  const V w = hn::Set(d, weight);
  for (int i = 0; i < n; ++i) hn::StoreU(hn::Div(hn::LoadU(d, &sum[i].r), w), d, &out[i].r);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
const ResolveKernels ResolveKernels::HWY_NAMESPACE = {.resolve = HWY_NAMESPACE::resolve,
                                                      .over = HWY_NAMESPACE::over,
                                                      .resolve_samples = HWY_NAMESPACE::resolve_samples,
                                                      .add = HWY_NAMESPACE::add,
                                                      .divide = HWY_NAMESPACE::divide};
}  // namespace zoneplate
