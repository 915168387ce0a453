#pragma once

#include <string>

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/obj/mtl.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A material of an MTL file as ours, its images loaded. `within` is the folder of the MTL file, as for find_file.
///
/// Kd, Ka, Ks and Ke are taken as sRGB codes, since programs write the colours there that they show. What is above 1
/// stays as it is. Blinn-Phong, which reflects Ka of ambient light, or Kd where there is no Ka; illum 0 is unlit, illum
/// 1 without highlights; with Pr or Pm, metallic-roughness. A black Kd or Ke under an image counts as white, with a
/// warning. d below 1, or a map_d that is not opaque, makes the material blended; map_d becomes the alpha of the base
/// colour image. All surfaces are double-sided: OBJ has no other.
Material make_material(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder);

}  // namespace zoneplate
