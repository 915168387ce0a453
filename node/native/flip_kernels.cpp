// SPDX-License-Identifier: Apache-2.0
// Debian's Highway has no vectors of doubles for WebAssembly.
#include "zoneplate/metrics/flip/weighted_sums.h"

namespace zoneplate {

template <>
const FlipKernels PerIsa<FlipKernels>::N_WASM = PerIsa<FlipKernels>::scalar;

}  // namespace zoneplate
