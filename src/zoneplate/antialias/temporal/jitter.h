// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/signal/samples.h"

namespace zoneplate::antialias {

/// Sequences of sample positions over frames.
enum class JitterSequence {
  Halton,           ///< bases 2 and 3; the mean of the period is the pixel's centre
  R2,               ///< multiples of the plastic number's powers; the mean of the period is the pixel's centre
  None,             ///< the pixel's centre
  UncentredHalton,  ///< bases 2 and 3, from element 1, as engines publish them: the image moves by what the mean lacks
};

/// The positions of a period of `length` frames.
SamplePattern jitter_pattern(JitterSequence sequence, int length);

}  // namespace zoneplate::antialias
