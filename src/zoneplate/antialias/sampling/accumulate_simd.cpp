#include <hwy/highway.h>

#include "zoneplate/antialias/sampling/accumulate_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Kernels = AccumulateKernels;
using DF = hn::CappedTag<float, 8>;
using VF = hn::Vec<DF>;
constexpr DF f32;
constexpr std::size_t lanes = hn::MaxLanes(DF());

HWY_INLINE VF set(float v) { return hn::Set(f32, v); }
HWY_INLINE VF greater(VF a, VF b) { return hn::IfThenElse(hn::Gt(a, b), a, b); }

/// A vector of pixels, channel by channel.
struct Pixels {
  VF r, g, b, a;
  HWY_INLINE explicit Pixels(const float* at) { hn::LoadInterleaved4(f32, at, r, g, b, a); }
  HWY_INLINE void store(float* at) const { hn::StoreInterleaved4(r, g, b, a, f32, at); }
  HWY_INLINE void scale(VF by) { r = hn::Mul(r, by), g = hn::Mul(g, by), b = hn::Mul(b, by); }
  HWY_INLINE VF greatest() const { return greater(greater(r, g), greater(b, hn::Zero(f32))); }
};

void weigh_karis(float exposure, float* color, float* weight, std::size_t n) {
  for (std::size_t i = 0; i < n; i += lanes) {
    Pixels c(color + 4 * i);
    const VF two = hn::Add(hn::Mul(set(Kernels::luma[0]), c.r), hn::Mul(set(Kernels::luma[1]), c.g));
    const VF luma = greater(hn::Add(two, hn::Mul(set(Kernels::luma[2]), c.b)), hn::Zero(f32));
    const VF w = hn::Div(set(1), hn::Add(set(1), hn::Mul(luma, set(exposure))));
    c.scale(w);
    c.a = hn::Mul(c.a, w);
    hn::StoreU(w, f32, weight + i);
    c.store(color + 4 * i);
  }
}

void map_max3(float* color, std::size_t n) {
  for (std::size_t i = 0; i < n; i += lanes) {
    Pixels c(color + 4 * i);
    c.scale(hn::Div(set(1), hn::Add(set(1), c.greatest())));
    c.store(color + 4 * i);
  }
}

void premultiply(float* color, std::size_t n) {
  for (std::size_t i = 0; i < n; i += lanes) {
    Pixels c(color + 4 * i);
    c.scale(c.a);
    c.store(color + 4 * i);
  }
}

void spread(const float* in, std::size_t step, const float* across, int taps, const float* down, float* const* rows,
            int row_count, std::size_t n) {
  for (std::size_t i = 0; i < n; i += lanes) {
    VF sum = hn::Mul(set(across[0]), hn::LoadU(f32, in + i));
    for (int d = 1; d < taps; ++d)
      sum = hn::Add(sum, hn::Mul(set(across[d]), hn::LoadU(f32, in + i + static_cast<std::size_t>(d) * step)));
    for (int k = 0; k < row_count; ++k)
      hn::StoreU(hn::Add(hn::LoadU(f32, rows[k] + i), hn::Mul(set(down[k]), sum)), f32, rows[k] + i);
  }
}

HWY_INLINE Pixels mean_at(const float* color, const float* weight, bool is_max3) {
  Pixels c(color);
  const VF w = hn::LoadU(f32, weight);
  c.r = hn::Div(c.r, w), c.g = hn::Div(c.g, w), c.b = hn::Div(c.b, w), c.a = hn::Div(c.a, w);
  if (!is_max3) return c;
  const VF most = c.greatest(), limit = set(Kernels::greatest_mapped);
  c.scale(hn::Div(set(1), hn::Sub(set(1), hn::IfThenElse(hn::Lt(most, limit), most, limit))));
  return c;
}

void mean(const float* color, const float* weight, bool is_max3, float* out, std::size_t n) {
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) mean_at(color + 4 * i, weight + i, is_max3).store(out + 4 * i);
  if (i == n) return;
  float rest[4 * lanes];
  mean_at(color + 4 * i, weight + i, is_max3).store(rest);
  for (std::size_t k = 0; k < 4 * (n - i); ++k) out[4 * i + k] = rest[k];
}

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const AccumulateKernels PerIsa<AccumulateKernels>::HWY_NAMESPACE = {.weigh_karis = HWY_NAMESPACE::weigh_karis,
                                                                    .map_max3 = HWY_NAMESPACE::map_max3,
                                                                    .premultiply = HWY_NAMESPACE::premultiply,
                                                                    .spread = HWY_NAMESPACE::spread,
                                                                    .mean = HWY_NAMESPACE::mean};
}  // namespace zoneplate
