// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/solid_texture.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/texture/solid_texture_lanes.h"

namespace zoneplate {

template <>
const SolidTextureKernels PerIsa<SolidTextureKernels>::scalar = stages::solid_texture<scalar::Float>();

}  // namespace zoneplate
