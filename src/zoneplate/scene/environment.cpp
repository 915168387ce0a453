// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/environment.h"

#include "zoneplate/base/error.h"

namespace zoneplate {

float3 Environment::constant_radiance() const {
  if (image >= 0) throw Error(ErrorKind::Input, "the scene has an environment image, which the renderer cannot draw");
  return strength == 1 ? color : color * strength;
}

}  // namespace zoneplate
