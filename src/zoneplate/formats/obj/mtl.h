// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The use of an image as an MTL file states it; the file name is unchanged. An empty name means no image.
struct MtlTexture {
  std::string file;
  float2 offset{0, 0}, scale{1, 1};  ///< -o, -s: the coordinate is offset + scale × uv, origin at the bottom left
  bool clamp = false;                ///< -clamp on
  float strength = 1;                ///< -bm
  // MTL has none of these; the other formats whose materials are converted to MTL's have.
  float rotation = 0;  ///< radians, counter-clockwise; after the scale, before the offset
  int uv_set = 0;
};

/// A material as stated in an MTL file; the colours are unchanged.
struct MtlMaterial {
  std::string name;
  std::optional<float3> diffuse, ambient, specular, emissive;     ///< Kd Ka Ks Ke
  std::optional<float> exponent, opacity, transparency;           ///< Ns d Tr
  std::optional<float> roughness, metallic, sheen;                ///< Pr Pm Ps
  std::optional<float> clearcoat, clearcoat_roughness;            ///< Pc Pcr
  std::optional<float> anisotropy, anisotropy_rotation;           ///< aniso anisor, the latter in turns
  std::optional<float> index_of_refraction;                       ///< Ni
  std::optional<int> illumination;                                ///< illum
  MtlTexture diffuse_map, emissive_map, opacity_map, normal_map;  ///< map_Kd map_Ke map_d norm
  MtlTexture specular_map, exponent_map;                          ///< map_Ks map_Ns
  MtlTexture roughness_map, metallic_map;                         ///< map_Pr map_Pm
  MtlTexture bump_map, displacement_map;                          ///< map_bump or bump; disp
  std::vector<std::string> unsupported;                           ///< keys of maps that are not drawn, each once
};

/// Reads the materials of an MTL file whose names `is_used` accepts. Errors in the file are ignored with a warning that
/// names `file` and line.
///
/// Errors    those of check_deadline, and those of is_used.
std::vector<MtlMaterial> parse_mtl(
    std::string_view text, const std::string& file, std::vector<std::string>& warnings,
    const std::function<bool(const std::string&)>& is_used = [](const std::string&) { return true; });

}  // namespace zoneplate
