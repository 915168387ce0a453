// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/filtering.h"

#include <algorithm>
#include <cstddef>

#include "zoneplate/math/lanes.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/shade/texture/filtering_lanes.h"
#include "zoneplate/shade/texture/texture.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {

namespace {

/// The sampler that a filter stands for, with the wrap modes of another; filters of other kernels leave it as it is.
Sampler replaced(Sampler sampler, const TextureFilter& filter) {
  using Kind = TextureFilter::Kind;
  const auto set = [&](TexelFilter texels, LevelFilter levels, int anisotropy) {
    sampler.magnify = sampler.minify = texels, sampler.level = levels, sampler.anisotropy = anisotropy;
  };
  if (filter.kind == Kind::Nearest) set(TexelFilter::Nearest, LevelFilter::None, 1);
  if (filter.kind == Kind::Bilinear) set(TexelFilter::Linear, LevelFilter::None, 1);
  if (filter.kind == Kind::Trilinear) set(TexelFilter::Linear, LevelFilter::Linear, 1);
  if (filter.kind == Kind::Probes) set(TexelFilter::Linear, LevelFilter::Linear, filter.anisotropy);
  return sampler;
}

/// True for filters that FilteringKernels evaluate.
bool is_by_taps(TextureFilter::Kind kind) {
  using Kind = TextureFilter::Kind;
  return kind == Kind::BySampler || kind == Kind::Nearest || kind == Kind::Bilinear || kind == Kind::Trilinear ||
         kind == Kind::Probes;
}

}  // namespace

SamplerState make_filtering(const Sampler& of, int anisotropy, const TextureFilter& filter) {
  if (filter.kind != TextureFilter::Kind::BySampler) anisotropy = 1;
  const Sampler sampler = replaced(of, filter);
  const bool blends = sampler.level == LevelFilter::Linear && sampler.minify == TexelFilter::Linear;
  SamplerState state = {
      .mirror_u = sampler.wrap_u == Wrap::Mirror,
      .clamp_u = sampler.wrap_u == Wrap::Clamp,
      .mirror_v = sampler.wrap_v == Wrap::Mirror,
      .clamp_v = sampler.wrap_v == Wrap::Clamp,
      .nearest_magnify = sampler.magnify == TexelFilter::Nearest,
      .nearest_minify = sampler.minify == TexelFilter::Nearest,
      .has_mips = sampler.level != LevelFilter::None,
      .blends_mips = sampler.level == LevelFilter::Linear,
      .anisotropy = blends ? std::clamp(std::max(anisotropy, sampler.anisotropy), 1, SamplerState::max_anisotropy) : 1};
  if (is_by_taps(filter.kind)) return state;
  state.kind = filter.kind;
  state.anisotropy = filter.anisotropy;
  return state;
}

namespace scalar {
namespace {

/// a + (b - a) × weight / 32768, to the nearest.
std::int32_t mix(std::int32_t a, std::int32_t b, std::int32_t weight) { return a + (((b - a) * weight + 16384) >> 15); }

template <class Code>
std::int32_t mix_level(const Code* codes, int shift, const Taps& taps, int level, int point, int channel) {
  const auto code = [&](std::int32_t texel) {
    return static_cast<std::int32_t>(codes[std::ptrdiff_t{4} * texel + channel]) << shift;
  };
  const std::int32_t upper = taps.upper[level][point], lower = taps.lower[level][point];
  const std::int32_t right = taps.right(level, point), down = taps.down(level, point);
  return mix(mix(code(upper), code(lower), down), mix(code(upper + 1), code(lower + 1), down), right);
}

template <class Code>
void mix_codes(const Code* codes, int shift, float unit, const Taps& taps, float* const out[4], int count) {
  for (int i = 0; i < count; ++i)
    for (int c = 0; c < 4; ++c) {
      std::int32_t value = mix_level(codes, shift, taps, 0, i, c);
      const std::int32_t mip_weight = taps.mip_weight[Taps::by_fours(i)];
      if (mip_weight > 0) value = mix(value, mix_level(codes, shift, taps, 1, i, c), mip_weight);
      out[c][i] = static_cast<float>(value) * unit;
    }
}

float mix(float a, float b, float weight) { return a + (b - a) * weight; }

float value_of(float value) { return value; }
float value_of(Half half) { return half_value(half.bits); }

/// `Value` is float or Half.
template <class Value>
float mix_level(const Value* values, const Taps& taps, int level, int point, int channel) {
  const Value* const upper = values + std::ptrdiff_t{4} * taps.upper[level][point] + channel;
  const Value* const lower = values + std::ptrdiff_t{4} * taps.lower[level][point] + channel;
  const float right = static_cast<float>(taps.right(level, point)) * 0x1p-15f;
  const float down = static_cast<float>(taps.down(level, point)) * 0x1p-15f;
  return mix(mix(value_of(upper[0]), value_of(lower[0]), down), mix(value_of(upper[4]), value_of(lower[4]), down),
             right);
}

template <class Value>
void mix_values(const Value* values, const Taps& taps, float* const out[4], int count) {
  for (int i = 0; i < count; ++i)
    for (int c = 0; c < 4; ++c) {
      const float value = mix_level(values, taps, 0, i, c);
      const int mip_weight = taps.mip_weight[Taps::by_fours(i)];
      const float weight = static_cast<float>(mip_weight) * 0x1p-15f;
      out[c][i] = mip_weight > 0 ? mix(value, mix_level(values, taps, 1, i, c), weight) : value;
    }
}

void mix_taps(const TextureView& t, const Taps& taps, float* const out[4], int count) {
  if (t.unorm8 != nullptr) return mix_codes(t.unorm8, 7, 1.0f / 32640.0f, taps, out, count);
  if (t.unorm15 != nullptr) return mix_codes(t.unorm15, 0, 1.0f / 32767.0f, taps, out, count);
  if (t.halves != nullptr) return mix_values(t.halves, taps, out, count);
  mix_values(t.values, taps, out, count);
}

void sample_anisotropic(const TextureView& t, const SamplerState& f, const Footprint& at, float* const out[4],
                        int count) {
  zoneplate::sample_anisotropic<Float>(
      t, f, at, out, count, [&](const Taps& taps, float* const probe[4], int n) { mix_taps(t, taps, probe, n); });
}

}  // namespace

}  // namespace scalar

template <>
const FilteringKernels PerIsa<FilteringKernels>::scalar = {.find_taps = &find_taps<scalar::Float, TextureView>,
                                                           .mix_taps = &scalar::mix_taps,
                                                           .sample_anisotropic = &scalar::sample_anisotropic};
}  // namespace zoneplate
