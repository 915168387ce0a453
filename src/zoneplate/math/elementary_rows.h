// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

enum class Elementary { Exp2, Exp, Log2, Log, Pow, Sin, Cos, Atan2, Acos, Asin };

/// The functions of math/elementary.h over arrays.
struct ElementaryKernels : PerIsa<ElementaryKernels> {
  /// out[i] = function(a[i]), or function(a[i], b[i]) for Pow (x, y) and Atan2 (y, x); b has n values for these two.
  void (*evaluate)(Elementary function, const float* a, const float* b, float* out, std::size_t n);
};

}  // namespace zoneplate
