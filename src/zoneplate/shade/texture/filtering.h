// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/scene/texture_filter.h"

namespace zoneplate {

struct TextureView;

/// The state of a sampler in the form that kernels read.
struct SamplerState {
  bool mirror_u = false, clamp_u = false;  ///< neither: repeat
  bool mirror_v = false, clamp_v = false;
  bool nearest_magnify = false, nearest_minify = false;
  bool has_mips = true, blends_mips = true;
  std::int32_t anisotropy = 1;  ///< maximum number of probes along a footprint, in [1, max_anisotropy]; 1: isotropic
  static constexpr std::int32_t max_anisotropy = 16;
  /// BySampler: FilteringKernels, by the members above. Otherwise AreaFilterKernels, which read the wrap modes only,
  /// and Ewa the anisotropy.
  TextureFilter::Kind kind = TextureFilter::Kind::BySampler;
  bool operator==(const SamplerState&) const = default;
};
/// The state of a sampler. The greater of `anisotropy` and the sampler's own value applies, but only to samplers that
/// blend mip levels. A filter other than BySampler replaces all but the wrap modes.
SamplerState make_filtering(const Sampler& sampler, int anisotropy = 1, const TextureFilter& filter = {});

/// The texture coordinates of fragments, and their screen-space derivatives per pixel.
struct Footprint {
  const float *u, *v;
  const float *dudx, *dvdx, *dudy, *dvdy;

  /// One flag for each group of eight fragments, or null. A flag that is set means that all fragments of the group have
  /// the derivatives of the fragment before it; those entries of the arrays are undefined.
  const bool* repeats = nullptr;

  /// For TextureFilter::Kind::Stochastic: three numbers in [0, 1) of each fragment, in three arrays.
  const float* random[3] = {};
};

/// The texels that fragments read, and their weights: of each of two mip levels, the indices of the upper left and the
/// lower left texel of a block of four. The right texels follow the left ones in memory. A texel without weight may lie
/// outside the level. Where no mip weight is above 0 the second level is not read.
///
/// Units     weights in 1/32768.
struct Taps {
  static constexpr int capacity = 256;
  static constexpr int groups = capacity / 8;
  static constexpr int padded_capacity = capacity + 16;  ///< as FragmentBatch::padded_capacity
  alignas(64) std::int32_t upper[2][padded_capacity], lower[2][padded_capacity];
  /// Weights of the right texels and of the lower texels, in the order of by_fours.
  alignas(64) std::int16_t bilinear_weight[2][2 * padded_capacity];
  /// Weight of the second level, stored twice, in the order of by_fours.
  alignas(64) std::int16_t mip_weight[2 * padded_capacity];
  alignas(64) float lod[padded_capacity];  ///< log2 of the footprint; an intermediate result

  /// The index of fragment i's first value in an array of pairs by fours: the first values of four fragments, then
  /// their second values.
  static constexpr int by_fours(int i) { return i / 4 * 8 + i % 4; }
  std::int32_t right(int level, int i) const { return bilinear_weight[level][by_fours(i)]; }
  std::int32_t down(int level, int i) const { return bilinear_weight[level][by_fours(i) + 4]; }
};

/// Texture look-up in two stages. Counts are multiples of 8, at most Taps::capacity; a footprint's arrays may be read
/// up to the next multiple of 16.
///
/// The LOD is log2 of the footprint: D = ½ log2 max(|∂(s,t)/∂x|², |∂(s,t)/∂y|²) with (s, t) in texels of level 0,
/// clamped to the texture's levels. D > 0 minifies, else the image is magnified. The coordinate is wrapped before it is
/// scaled to a level. Nearest filtering takes the texel that contains the coordinate; linear filtering the four texels
/// whose centres surround it, mixed by their distances: first along y, then x, then between levels (floor D and the
/// next; or, without blending, the level nearest to D).
///
/// LOD and weights are truncated after 15 bits; log2 is coarse_log2.
///
/// Edges     any coordinate and any derivative, infinities and NaN included, give texels inside the texture.
/// Exact     a coordinate at a texel's centre (of a size that is a power of two) gives that texel; texels of one value
///           give that value; 0 and 1 are exact. Mixing is in fixed point: unorm8 texels with 7 more fraction bits,
///           unorm15 texels without, weights of 15 bits, each mix rounded to the nearest. The error of a value is at
///           most 2 units of 1/32640 or 1/32767, where graphics interfaces require weights of 8 bits. Float textures
///           are mixed in floats, with the same weights; half floats likewise, after their exact conversion to floats.
/// Source    Williams, Pyramidal Parametrics, SIGGRAPH 1983; OpenGL 4.6 core, section 8.14, with the isotropic
///           scale factor ρ of equation 8.8 and c = 0.
struct FilteringKernels : PerIsa<FilteringKernels> {
  void (*compute_taps)(const TextureView& texture, const SamplerState& filtering, const Footprint& footprint, Taps& out,
                       int count);
  void (*mix_taps)(const TextureView& texture, const Taps& taps, float* const out[4], int count);

  /// Both stages for footprints that are longer than wide: the mean of N probes along the longer axis, each the
  /// trilinear mean at the LOD of the shorter axis, which counts as at least a texel of level 0 and as at least an
  /// `anisotropy`-th of the longer one. N is 2/3 of the ratio of the axes, rounded up; probe i of N lies at
  /// (i - 1/2) / N - 1/2 of the axis.
  ///
  /// Exact     texels of one value give that value. A mean in fixed point is that of the probes before, mixed with the
  ///           next one with the weight 1 / i: the error grows by at most half a unit for each probe.
  /// Source    EXT_texture_filter_anisotropic, with fewer probes: a trilinear probe is wider than its texels. On the
  ///           city of the benchmark, against 256 samples a pixel, as many probes as the ratio are 0.8 dB better,
  ///           half as many 1.4 dB worse.
  void (*sample_anisotropic)(const TextureView& texture, const SamplerState& filtering, const Footprint& footprint,
                             float* const out[4], int count);
};

}  // namespace zoneplate
