// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/filtering.h"

#include <algorithm>
#include <cstddef>

#include "zoneplate/math/lanes.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/shade/texture/filtering_lanes.h"
#include "zoneplate/shade/texture/probes_lanes.h"
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

/// The taps of a fragment on one level.
struct LevelTaps {
  std::int32_t upper, lower, right, down;
};
/// The taps of a fragment on both levels.
struct FragmentTaps {
  LevelTaps level[2];
  std::int32_t mip_weight;
};

FragmentTaps taps_at(const Taps& taps, int i) {
  FragmentTaps out{.level = {}, .mip_weight = taps.mip_weight[Taps::by_fours(i)]};
  for (int n = 0; n < 2; ++n) out.level[n] = {taps.upper[n][i], taps.lower[n][i], taps.right(n, i), taps.down(n, i)};
  return out;
}
FragmentTaps taps_at(const ProbeGroup& group, const ProbeTaps& taps, int i) {
  const int at = Taps::by_fours(i);
  FragmentTaps out{.level = {}, .mip_weight = group.mip_weight[at]};
  for (int n = 0; n < (group.has_second ? 2 : 1); ++n) {
    const std::int32_t upper = taps.upper[n][i], lower = group.has_pitch ? upper + group.pitch[n] : taps.lower[n][i];
    out.level[n] = {upper, lower, taps.bilinear_weight[n][at], taps.bilinear_weight[n][at + 4]};
  }
  return out;
}

template <class Code>
std::int32_t mix_level(const Code* codes, int shift, const LevelTaps& taps, int channel) {
  const auto code = [&](std::int32_t texel) {
    return static_cast<std::int32_t>(codes[std::ptrdiff_t{4} * texel + channel]) << shift;
  };
  return mix(mix(code(taps.upper), code(taps.lower), taps.down),
             mix(code(taps.upper + 1), code(taps.lower + 1), taps.down), taps.right);
}

/// 8 or 15 bits: their value in 1/32640 or 1/32767.
template <class Code>
struct Codes {
  const Code* codes;
  int shift;
  float unit;

  std::int32_t mix_levels(const FragmentTaps& taps, int channel) const {
    const std::int32_t first = mix_level(codes, shift, taps.level[0], channel);
    return taps.mip_weight > 0 ? mix(first, mix_level(codes, shift, taps.level[1], channel), taps.mip_weight) : first;
  }
  static std::int32_t mean(std::int32_t before, std::int32_t probe, std::int32_t weight) {
    return mix(before, probe, weight);
  }
  float value(std::int32_t mixed) const { return static_cast<float>(mixed) * unit; }
};

float mix(float a, float b, float weight) { return a + (b - a) * weight; }

float value_of(float value) { return value; }
float value_of(Half half) { return half_value(half.bits); }

template <class Value>
float mix_level(const Value* values, const LevelTaps& taps, int channel) {
  const Value* const upper = values + std::ptrdiff_t{4} * taps.upper + channel;
  const Value* const lower = values + std::ptrdiff_t{4} * taps.lower + channel;
  const float right = static_cast<float>(taps.right) * 0x1p-15f;
  const float down = static_cast<float>(taps.down) * 0x1p-15f;
  return mix(mix(value_of(upper[0]), value_of(lower[0]), down), mix(value_of(upper[4]), value_of(lower[4]), down),
             right);
}

/// `Value` is float or Half.
template <class Value>
struct Values {
  const Value* values;

  float mix_levels(const FragmentTaps& taps, int channel) const {
    const float first = mix_level(values, taps.level[0], channel);
    const float weight = static_cast<float>(taps.mip_weight) * 0x1p-15f;
    return taps.mip_weight > 0 ? mix(first, mix_level(values, taps.level[1], channel), weight) : first;
  }
  static float mean(float before, float probe, std::int32_t weight) {
    return mix(before, probe, static_cast<float>(weight) * 0x1p-15f);
  }
  static float value(float mixed) { return mixed; }
};

/// Calls body(texels) with the texels that the texture has.
template <class Body>
void with_texels(const TextureView& t, const Body& body) {
  if (t.unorm8 != nullptr) return body(Codes<std::uint8_t>{t.unorm8, 7, 1.0f / 32640.0f});
  if (t.unorm15 != nullptr) return body(Codes<std::uint16_t>{t.unorm15, 0, 1.0f / 32767.0f});
  if (t.halves != nullptr) return body(Values<Half>{t.halves});
  body(Values<float>{t.values});
}

void mix_taps(const TextureView& t, const Taps& taps, float* const out[4], int count) {
  with_texels(t, [&](const auto& texels) {
    for (int i = 0; i < count; ++i) {
      const FragmentTaps at = taps_at(taps, i);
      for (int c = 0; c < 4; ++c) out[c][i] = texels.value(texels.mix_levels(at, c));
    }
  });
}

/// Mixes the probes of each fragment to their mean.
void mix_probes(const TextureView& t, const ProbeList& of, float* const out[4]) {
  with_texels(t, [&](const auto& texels) {
    const ProbeTaps* taps = of.taps;
    for (int i = of.first; i < of.last; i += 8) {
      const ProbeGroup& group = of.group[(i - of.first) / 8];
      for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 4; ++c) {
          auto mean = texels.mix_levels(taps_at(group, taps[0], k), c);
          for (int n = 1; n < group.probes; ++n) {
            const int weight = taps[n].mean_weight[Taps::by_fours(k)];
            if (weight > 0) mean = texels.mean(mean, texels.mix_levels(taps_at(group, taps[n], k), c), weight);
          }
          out[c][i + k] = texels.value(mean);
        }
      taps += group.probes;
    }
  });
}

void sample_anisotropic(const TextureView& t, const SamplerState& f, const Footprint& at, float* const out[4],
                        int count) {
  zoneplate::sample_anisotropic<Float, Float, NotJoined<Float>>(
      t, f, at, count, [&](const ProbeList& probes) { mix_probes(t, probes, out); });
}

}  // namespace

}  // namespace scalar

template <>
const FilteringKernels PerIsa<FilteringKernels>::scalar = {.compute_taps = &compute_taps<scalar::Float, TextureView>,
                                                           .mix_taps = &scalar::mix_taps,
                                                           .sample_anisotropic = &scalar::sample_anisotropic};
}  // namespace zoneplate
