// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {

struct RipmapView;
struct SumsView;
struct TextureView;

/// Texture filters beyond the taps of FilteringKernels: slower, of higher quality or for comparison. Counts and
/// footprints as there.
///
/// Edges     any coordinate and any derivative, infinities and NaN included, give texels inside the texture.
/// Exact     in floats, in a fixed order. A result is the centre texel plus the weighted mean of the others'
///           differences from it, so that texels of one value give that value to the bit. Values are clamped to the
///           range of the texture.
struct AreaFilterKernels : PerIsa<AreaFilterKernels> {
  /// CatmullRom, BSpline, Mitchell: 4 × 4 texels of the two mip levels about the LOD of FilteringKernels; of level 0
  /// alone where the image is magnified.
  void (*sample_cubic)(const TextureView& texture, const SamplerState& filtering, const Footprint& footprint,
                       float* const out[4], int count);

  /// Ripmap: bilinear in four levels. The LOD along u is log2 of the footprint's extent along u, likewise for v: the
  /// filtered area is the bounding box of the footprint.
  void (*sample_ripmap)(const RipmapView& ripmap, const SamplerState& filtering, const Footprint& footprint,
                        float* const out[4], int count);

  /// Ewa: the mean of the texels within the ellipse to which the derivatives map a circle of radius one pixel, weighted
  /// by exp(-2 r²) - exp(-2) with r = 1 at the ellipse, in the two mip levels in which the shorter semi-axis is 1 to 2
  /// and 2 to 4 texels long, mixed by that length.
  ///
  /// The shorter semi-axis is lengthened where the longer is more than `anisotropy` times as long; each is at least one
  /// texel of level 0.
  /// Cost      about 6 × the ratio of the axes × 2 to 4 texels.
  /// Source    Heckbert, Fundamentals of Texture Mapping and Image Warping, UC Berkeley 1989; mip levels: Greene and
  ///           Heckbert 1986.
  void (*sample_ellipse)(const TextureView& texture, const SamplerState& filtering, const Footprint& footprint,
                         float* const out[4], int count);

  /// Stochastic: the texel (floor(u w + r1 - ½), floor(v h + r2 - ½)) of level floor(LOD + r0), for the footprint's
  /// random numbers r: each texel that trilinear filtering reads, with the probability of its weight.
  void (*sample_one)(const TextureView& texture, const SamplerState& filtering, const Footprint& footprint,
                     float* const out[4], int count);
};

/// Sat: the mean over the bounding box of the footprint's parallelogram about the coordinate, at least one texel wide
/// and high and at most the image, with fractional edges. With Wrap::Clamp the box is cut at the image's border.
///
/// Exact     in integers for unorm texels (edges in 1/256 texel), else in double.
void sample_sums(const SumsView& sums, const SamplerState& filtering, const Footprint& footprint, float* const out[4],
                 int count);

/// The size of footprints in a texture: log2 of the longer derivative in texels of level 0, which is the LOD of
/// FilteringKernels before it is clamped to the levels; and the ratio of the longer to the shorter semi-axis of the
/// ellipse to which the derivatives map a circle, at most 1024.
void measure_footprints(const TextureView& texture, const Footprint& footprint, float* mip_level, float* anisotropy,
                        int count);

/// Samples by the filter of `filtering`, which is not BySampler; ripmaps and summed-area tables are made at first use.
void sample_area(const Texture& texture, const SamplerState& filtering, const Footprint& footprint, float* const out[4],
                 int count);

}  // namespace zoneplate
