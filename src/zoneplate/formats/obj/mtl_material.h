// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/obj/mtl.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Converts a material of an MTL file and loads its images. `within` is the folder of the MTL file, as for find_file.
///
/// Kd, Ka, Ks and Ke are sRGB-encoded, as programs write display colours; values above 1 are kept unchanged. The model
/// is Blinn-Phong with the ambient reflectance Ka, or Kd if there is no Ka; illum 0 is unlit, illum 1 has no
/// highlights; with Pr or Pm the model is metallic-roughness. A black Kd or Ke with an image is taken as white, with a
/// warning. d below 1, or a map_d that is not opaque, makes the material blended; map_d becomes the alpha of the base
/// colour image. All surfaces are double-sided, because OBJ has no single-sided surfaces.
Material make_material(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder);

}  // namespace zoneplate
