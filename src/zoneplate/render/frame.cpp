#include "zoneplate/render/frame.h"

namespace zoneplate {

Planes Planes::operator|(const Planes& o) const {
  return {.depth = depth || o.depth,
          .normal = normal || o.normal,
          .albedo = albedo || o.albedo,
          .uv = uv || o.uv,
          .object_id = object_id || o.object_id,
          .material_id = material_id || o.material_id,
          .primitive_id = primitive_id || o.primitive_id,
          .coverage = coverage || o.coverage,
          .position = position || o.position,
          .motion = motion || o.motion,
          .flow = flow || o.flow,
          .error = error || o.error,
          .samples = samples || o.samples,
          .sample_triangles = sample_triangles || o.sample_triangles,
          .sample_colors = sample_colors || o.sample_colors};
}

}  // namespace zoneplate
