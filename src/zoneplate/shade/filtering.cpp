#include "zoneplate/shade/filtering.h"

#include <cstddef>

#include "zoneplate/scene/material.h"
#include "zoneplate/shade/filtering_stages.h"
#include "zoneplate/shade/lanes.h"
#include "zoneplate/shade/texture.h"

namespace zoneplate {

Filtering make_filtering(const Sampler& sampler) {
  return {.mirror_u = sampler.wrap_u == Wrap::Mirror,
          .clamp_u = sampler.wrap_u == Wrap::Clamp,
          .mirror_v = sampler.wrap_v == Wrap::Mirror,
          .clamp_v = sampler.wrap_v == Wrap::Clamp,
          .nearest_magnify = sampler.magnify == TexelFilter::Nearest,
          .nearest_minify = sampler.minify == TexelFilter::Nearest,
          .has_levels = sampler.level != LevelFilter::None,
          .blends_levels = sampler.level == LevelFilter::Linear};
}

namespace scalar {
namespace {

float mix(float a, float b, float weight) { return a + (b - a) * weight; }

template <class Code>
float mix_level(const Code* codes, const Taps& taps, int level, int point, int channel) {
  const auto code = [&](int corner) {
    return static_cast<float>(codes[std::ptrdiff_t{4} * taps.texel[level][corner][point] + channel]);
  };
  const float right = taps.right[level][point];
  return mix(mix(code(0), code(1), right), mix(code(2), code(3), right), taps.down[level][point]);
}

template <class Code>
void mix_codes(const Code* codes, float unit, const Taps& taps, float* const out[4], int count) {
  for (int i = 0; i < count; ++i)
    for (int c = 0; c < 4; ++c) {
      float value = mix_level(codes, taps, 0, i, c);
      if (taps.blend[i] > 0) value = mix(value, mix_level(codes, taps, 1, i, c), taps.blend[i]);
      out[c][i] = value * unit;
    }
}

void mix_taps(const TextureView& t, const Taps& taps, float* const out[4], int count) {
  if (t.codes8 != nullptr) return mix_codes(t.codes8, 1.0f / 255.0f, taps, out, count);
  mix_codes(t.codes16, 1.0f / 65535.0f, taps, out, count);
}

}  // namespace

const FilteringKernels filtering_kernels = {&find_taps<Float, TextureView>, &mix_taps};

}  // namespace scalar
}  // namespace zoneplate
