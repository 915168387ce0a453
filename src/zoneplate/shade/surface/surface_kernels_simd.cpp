#include "zoneplate/shade/surface/surface_kernels.h"

#include "zoneplate/shade/lanes/lanes_simd.h"
#include "zoneplate/shade/surface/surface_stages.h"

namespace zoneplate {
template <>
const SurfaceKernels PerIsa<SurfaceKernels>::HWY_NAMESPACE =
    stages::all<HWY_NAMESPACE::Float, HWY_NAMESPACE::WideFloat>();
}  // namespace zoneplate
