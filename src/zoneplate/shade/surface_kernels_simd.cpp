#include "zoneplate/shade/surface_kernels.h"

#include "zoneplate/shade/lanes_simd.h"
#include "zoneplate/shade/surface_stages.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {

const SurfaceKernels surface_kernels = stages::all<Float>();

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
