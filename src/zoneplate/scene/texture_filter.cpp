// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/texture_filter.h"

namespace zoneplate {

std::span<const TextureFilterEntry> texture_filters() {
  using Kind = TextureFilter::Kind;
  static const Param probes{
      .name = "anisotropy", .meaning = "the greatest ratio of the footprint's axes", .value = 16, .low = 2, .high = 16};
  static const Param ratio{
      .name = "anisotropy", .meaning = "the greatest ratio of the ellipse's axes", .value = 16, .low = 1, .high = 64};
  static const std::vector<TextureFilterEntry> table = {
      {"nearest", "the texel of level 0 that contains the coordinate", "", {}, Kind::Nearest},
      {"bilinear", "the four nearest texels of level 0", "", {}, Kind::Bilinear},
      {"trilinear",
       "bilinear in the two nearest mip levels",
       "Williams, Pyramidal Parametrics, SIGGRAPH 1983",
       {},
       Kind::Trilinear},
      {"catmull-rom",
       "4 × 4 texels of two mip levels, by the cubic that interpolates",
       "Catmull and Rom, A class of local interpolating splines, 1974",
       {},
       Kind::CatmullRom},
      {"b-spline",
       "4 × 4 texels of two mip levels, by the cubic without negative lobes",
       "Schoenberg, Contributions to the problem of approximation of equidistant data, 1946",
       {},
       Kind::BSpline},
      {"mitchell",
       "4 × 4 texels of two mip levels, by the cubic between these two",
       "Mitchell and Netravali, Reconstruction Filters in Computer Graphics, SIGGRAPH 1988",
       {},
       Kind::Mitchell},
      {"ripmap",
       "bilinear in levels that are reduced along each axis separately",
       "Larson and Shah, US patent 5222205, 1990",
       {},
       Kind::Ripmap},
      {"probes",
       "trilinear probes along the longer axis of the footprint, as GPUs do",
       "EXT_texture_filter_anisotropic, 1999",
       {probes},
       Kind::Probes},
      {"ewa",
       "Gaussian-weighted mean over the footprint's ellipse",
       "Greene and Heckbert, Creating Raster Omnimax Images Using the Elliptical Weighted Average Filter, 1986",
       {ratio},
       Kind::Ewa},
      {"sat",
       "mean over the footprint's bounding box, from a summed-area table",
       "Crow, Summed-Area Tables for Texture Mapping, SIGGRAPH 1984",
       {},
       Kind::Sat},
      {"stochastic",
       "one random texel, by the weights of trilinear filtering: filtering follows shading",
       "Pharr et al., Filtering After Shading With Stochastic Texture Filtering, I3D 2024",
       {},
       Kind::Stochastic}};
  return table;
}

TextureFilter parse_texture_filter(std::string_view text) {
  const auto spec = parse_spec("texture filter", texture_filters(), text);
  TextureFilter filter{.kind = spec.row.kind};
  if (!spec.row.params.empty()) filter.anisotropy = spec.settings.integer("anisotropy");
  return filter;
}

}  // namespace zoneplate
