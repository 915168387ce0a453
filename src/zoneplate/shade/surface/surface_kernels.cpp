#include "zoneplate/shade/surface/surface_kernels.h"

#include "zoneplate/shade/lanes/lanes.h"
#include "zoneplate/shade/surface/surface_stages.h"

namespace zoneplate::scalar {

const SurfaceKernels surface_kernels = stages::all<Float, WideFloat>();

}  // namespace zoneplate::scalar
