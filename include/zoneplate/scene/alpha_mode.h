// SPDX-License-Identifier: Apache-2.0
#pragma once

#pragma GCC visibility push(default)
namespace zoneplate {

/// How a surface's alpha is used (glTF 2.0, section 3.9.4).
enum class AlphaMode {
  Opaque,  ///< Alpha is ignored.
  Mask,    ///< The surface is present where alpha reaches a cutoff, and opaque there.
  Blend,   ///< The surface is composited over what lies behind it, in exact depth order.
};

}  // namespace zoneplate
#pragma GCC visibility pop
