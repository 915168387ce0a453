// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/obj/mtl.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Converts a material of an MTL file and loads its images. `within` is the folder of the MTL file, as for find_file.
///
/// Kd, Ka, Ks and Ke are sRGB-encoded, as programs write display colours. Values above 1 are unchanged. The model is
/// Blinn-Phong, with the ambient reflectance Ka, or Kd without a Ka; illum 0 is unlit, illum 1 without highlights; with
/// Pr, Pm or a map of them, metallic-roughness with the layers of Ps, Pc, Pcr, aniso and anisor and the index of
/// refraction Ni. map_Ks multiplies Ks, map_Ns Ns. A black Kd, Ks or Ke with an image counts as white, with a warning.
/// map_bump, or else disp, is a normal map where its texels are unit vectors, as several programs write it; otherwise
/// Material::height_texture, whose red channel counts, with the multiplier -bm as height_scale: load_obj converts it to
/// units of the model, such that the value 1 lies -bm × 1 % of the texture's width above the value 0.
/// Ks without an Ns above 0 has no highlight. Tr 1 or d 0, which would hide all surfaces, is opaque, with a warning.
/// d below 1, or a map_d that is not opaque, makes the material blended; map_d becomes the alpha of the base colour
/// image. All surfaces are double-sided, as OBJ has no other kind.
Material make_material(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder);

}  // namespace zoneplate
