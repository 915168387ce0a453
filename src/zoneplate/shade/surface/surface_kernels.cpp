#include "zoneplate/shade/surface/surface_kernels.h"

#include "zoneplate/shade/lanes/lanes.h"
#include "zoneplate/shade/surface/surface_stages.h"

namespace zoneplate {

template <>
const SurfaceKernels PerIsa<SurfaceKernels>::scalar = stages::all<scalar::Float, scalar::WideFloat>();

}  // namespace zoneplate
