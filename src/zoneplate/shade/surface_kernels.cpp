#include "zoneplate/shade/surface_kernels.h"

#include "zoneplate/shade/lanes.h"
#include "zoneplate/shade/surface_stages.h"

namespace zoneplate::scalar {

const SurfaceKernels surface_kernels = stages::all<Float, WideFloat>();

}  // namespace zoneplate::scalar
