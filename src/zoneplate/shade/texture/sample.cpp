// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/sample.h"

#include <algorithm>
#include <cassert>

#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {

void sample_area(const Texture& texture, const SamplerState& filtering, const Footprint& footprint, float* const out[4],
                 int count) {
  using Kind = TextureFilter::Kind;
  const AreaFilterKernels& kernels = AreaFilterKernels::of();
  switch (filtering.kind) {
    case Kind::CatmullRom:
    case Kind::BSpline:
    case Kind::Mitchell:
      return kernels.sample_cubic(texture.view(), filtering, footprint, out, count);
    case Kind::Ripmap:
      return kernels.sample_ripmap(texture.ripmap(), filtering, footprint, out, count);
    case Kind::Ewa:
      return kernels.sample_ellipse(texture.view(), filtering, footprint, out, count);
    case Kind::Stochastic:
      return kernels.sample_one(texture.view(), filtering, footprint, out, count);
    case Kind::Sat:
      return sample_sums(texture.sums(), filtering, footprint, out, count);
    case Kind::BySampler:
    case Kind::Nearest:
    case Kind::Bilinear:
    case Kind::Trilinear:
    case Kind::Probes:
      assert(false && "a filter of FilteringKernels");
  }
}

float4 sample(const Texture& texture, const Sampler& sampler, float2 uv, float2 dx, float2 dy) {
  return sample(texture, sampler, {}, uv, dx, dy);
}

float4 sample(const Texture& texture, const Sampler& sampler, const TextureFilter& filter, float2 uv, float2 dx,
              float2 dy, float3 random) {
  // Kernels process groups of eight fragments and may read up to the next multiple of 16.
  constexpr int count = 8, padded = 16;
  struct Array {
    alignas(64) float value[padded];
    explicit Array(float v) { std::fill_n(value, padded, v); }
  };
  const Array u(uv.x), v(uv.y), dudx(dx.x), dvdx(dx.y), dudy(dy.x), dvdy(dy.y);
  const Array numbers[3] = {Array(random.x), Array(random.y), Array(random.z)};
  const Footprint footprint{u.value,    v.value,    dudx.value, dvdx.value,
                            dudy.value, dvdy.value, nullptr,    {numbers[0].value, numbers[1].value, numbers[2].value}};
  Array red(0), green(0), blue(0), alpha(0);
  float* const out[4] = {red.value, green.value, blue.value, alpha.value};
  const SamplerState state = make_filtering(sampler, 1, filter);
  const FilteringKernels& kernels = FilteringKernels::of();
  if (state.kind != TextureFilter::Kind::BySampler) {
    sample_area(texture, state, footprint, out, count);
  } else if (state.anisotropy > 1) {
    kernels.sample_anisotropic(texture.view(), state, footprint, out, count);
  } else {
    Taps taps;
    kernels.compute_taps(texture.view(), state, footprint, taps, count);
    kernels.mix_taps(texture.view(), taps, out, count);
  }
  return {red.value[0], green.value[0], blue.value[0], alpha.value[0]};
}

}  // namespace zoneplate
