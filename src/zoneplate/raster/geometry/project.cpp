// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/project.h"

#include <cmath>

namespace zoneplate {

ScreenVertex project(float4 clip, Viewport viewport) {
  const float limit = static_cast<float>(guard_band);
  const float x = clip.x / clip.w * static_cast<float>(viewport.width * 128);
  const float y = clip.y / clip.w * static_cast<float>(viewport.height * -128);
  const bool inside = clip.w > 0 && clip.z >= 0 && clip.z <= clip.w && std::abs(x) <= limit && std::abs(y) <= limit;
  if (!inside) return {};
  // Adding +0 turns a depth of -0 into +0: the sign of zero must not reach an image.
  return {static_cast<std::int32_t>(std::nearbyint(x)), static_cast<std::int32_t>(std::nearbyint(y)),
          clip.z / clip.w + 0.0f, 1.0f / clip.w};
}

namespace scalar {
namespace {

void transform(const float4x4& clip_from_object, const float3* p, std::size_t n, Viewport viewport, ScreenVertex* out) {
  for (std::size_t i = 0; i < n; ++i) out[i] = project(clip_from_object * float4{p[i].x, p[i].y, p[i].z, 1}, viewport);
}

}  // namespace

}  // namespace scalar

template <>
const ProjectKernels PerIsa<ProjectKernels>::scalar = {.transform = scalar::transform};
}  // namespace zoneplate
