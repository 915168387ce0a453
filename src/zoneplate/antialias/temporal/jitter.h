// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/signal/samples.h"

namespace zoneplate::antialias {

/// Sequences of sample positions over frames.
enum class JitterSequence {
  Halton,  ///< bases 2 and 3, from element 1
  R2,      ///< multiples of the plastic number's powers, from (½, ½)
  None,    ///< the pixel's centre
};

/// The first `length` positions of a sequence.
///
/// Source    R2: Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018.
SamplePattern jitter_pattern(JitterSequence sequence, int length);

}  // namespace zoneplate::antialias
