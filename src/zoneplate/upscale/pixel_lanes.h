// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate::stages {

/// Loads a pixel of four floats per lane: channel c of the pixel at at(lane) into out[c].
template <class F, class At>
[[gnu::always_inline]] inline void load_pixels(const At& at, F (&out)[4]) {
  if constexpr (F::lanes == 1)
    for (int c = 0; c < 4; ++c) out[c] = F(at(0)[c]);
  else
    F::load_quads(at, out);
}

}  // namespace zoneplate::stages
