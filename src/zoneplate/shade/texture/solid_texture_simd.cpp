// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/solid_texture.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/texture/solid_texture_lanes.h"

namespace zoneplate {
template <>
const SolidTextureKernels PerIsa<SolidTextureKernels>::HWY_NAMESPACE =
    stages::solid_texture<HWY_NAMESPACE::WideFloat>();
}  // namespace zoneplate
