// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/material.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// The border of a convolution that continues a texture as its wrap mode does.
inline Border border_of(Wrap wrap) {
  return wrap == Wrap::Repeat ? Border::Wrap : wrap == Wrap::Mirror ? Border::Reflect : Border::Clamp;
}

}  // namespace zoneplate
