// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/jitter.h"

namespace zoneplate::antialias {

SamplePattern jitter_pattern(JitterSequence sequence, int length) {
  switch (sequence) {
    case JitterSequence::Halton:
      return named_pattern("halton", length);
    case JitterSequence::R2:
      return named_pattern("r2", length);
    case JitterSequence::None:
      return {SamplePosition{}};
    case JitterSequence::UncentredHalton:
      return halton_sequence(length);
  }
  return {SamplePosition{}};
}

}  // namespace zoneplate::antialias
