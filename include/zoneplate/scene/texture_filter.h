// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A texture filter for all textures of a scene, in place of the filters of their samplers. Wrap modes stay.
struct TextureFilter {
  /// The filters, in the order of `texture_filters`, after BySampler.
  enum class Kind {
    BySampler,   ///< the filters of each Sampler
    Nearest,     ///< the texel of level 0 that contains the coordinate
    Bilinear,    ///< the four nearest texels of level 0
    Trilinear,   ///< bilinear in two mip levels
    CatmullRom,  ///< 4 × 4 texels of two mip levels, weighted by the cubic B = 0, C = 1/2
    BSpline,     ///< the same, B = 1, C = 0
    Mitchell,    ///< the same, B = C = 1/3
    Ripmap,      ///< bilinear in levels that are reduced along u and v separately
    Probes,      ///< trilinear probes along the longer axis of the footprint
    Ewa,         ///< the Gaussian-weighted mean over the footprint's ellipse
    Sat,         ///< the mean over the bounding box of the footprint, from a summed-area table
    Stochastic,  ///< one texel at random, by the weights of trilinear filtering: filtering follows shading
  };
  Kind kind = Kind::BySampler;  ///< the filter
  int anisotropy = 16;  ///< Probes: the most probes, at most 16; Ewa: the greatest ratio of the axes, at most 64
  bool operator==(const TextureFilter&) const = default;
};

/// A row of the list of texture filters.
struct TextureFilterEntry {
  std::string_view name{};                                    ///< ewa in `ewa:anisotropy=16`
  std::string_view summary{};                                 ///< one line for listings
  std::string_view source{};                                  ///< the publication
  std::vector<Param> params{};                                ///< those of `TextureFilter`
  TextureFilter::Kind kind = TextureFilter::Kind::BySampler;  ///< the filter that it stands for
};

/// nearest, bilinear, trilinear, catmull-rom, b-spline, mitchell, ripmap, probes, ewa, sat, stochastic.
std::span<const TextureFilterEntry> texture_filters();

/// The filter of a text such as `trilinear` or `ewa:anisotropy=16`.
///
/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
TextureFilter parse_texture_filter(std::string_view text);

/// The filter that makes each mip level from the level before it.
enum class MipFilter {
  Box,      ///< the mean of the texels that a texel covers
  Kaiser,   ///< a sinc under Kaiser's window, of radius 3 and β = 6.5: sharper levels, at the price of some ringing
  Lanczos,  ///< a sinc under the middle lobe of a sinc, 3 lobes
};

/// How the mip levels of a scene's textures are made.
struct MipOptions {
  bool raw_colors = false;            ///< the values of images are taken as linear, not decoded from sRGB
  MipFilter filter = MipFilter::Box;  ///< between levels
  /// Scales the alpha of each level of alpha-tested base colours so that the fraction of texels that pass the test is
  /// that of level 0.
  bool keeps_coverage = false;
  /// Weights the base colours of alpha-tested and blended materials by alpha, so that the colours which transparent
  /// texels hide do not show along outlines. False: averaged without regard to alpha, as GPUs do.
  bool weights_by_alpha = true;
};

/// Widens reflection lobes by the variance of the normals within a pixel, which shading at one point misses.
enum class SpecularAntialiasing {
  None,       ///< the lobes as the material has them
  Geometric,  ///< by the change of the interpolated normal from pixel to pixel
  Toksvig,    ///< by the length of the mean normal of a normal map
  Lean,       ///< by the variances of the slopes of a normal map, added up over both axes
  Full,       ///< Geometric and Lean
};

}  // namespace zoneplate
#pragma GCC visibility pop
