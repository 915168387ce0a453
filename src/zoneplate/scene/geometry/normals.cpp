// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/normals.h"

#include "zoneplate/math/elementary.h"
#include "zoneplate/scene/geometry/smooth_normals.h"

namespace zoneplate {

void make_normals(Mesh& mesh, float crease) {
  mesh.tangent.clear();
  make_smooth_normals(mesh, crease == 0.87266463f ? smooth_crease_cosine : cos(crease));
}

}  // namespace zoneplate
