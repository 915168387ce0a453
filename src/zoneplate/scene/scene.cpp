// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/scene.h"

#include "zoneplate/scene/used_vertices.h"

namespace zoneplate {

Box Scene::bounds() const { return UsedVertices(*this).bounds(); }

}  // namespace zoneplate
