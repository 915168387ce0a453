// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/mat.h"
#include "zoneplate/raster/types/viewport.h"

namespace zoneplate {

/// A vertex on the screen, the input of coverage and depth.
///
/// Units     x, y in 1/256 pixel from the image's *centre*, x right, y down; |x|, |y| <= 2^22 (the guard band, ±16384
///           pixels); z is the reversed depth in [0, 1]. inv_w = 1 / w > 0, or 0 for a vertex outside the near plane,
///           the far plane or the guard band: its triangles must be clipped, and its other members are undefined.
struct ScreenVertex {
  std::int32_t x = 0, y = 0;
  float z = 0;
  float inv_w = 0;
  bool needs_clipping() const { return inv_w == 0; }
};

inline constexpr std::int32_t guard_band = 1 << 22;

/// Clip space to the screen, for one vertex: division by w, viewport transform, snap to 1/256 pixel (round half to
/// even).
///
/// Exact     x = round(clip.x / clip.w × 128 width), as floats; the image's centre is the origin, so that 24 bits
///           suffice.
ScreenVertex project(float4 clip, Viewport viewport);

struct ProjectKernels : PerIsa<ProjectKernels> {
  /// project(clip_from_object * p) for n positions.
  void (*transform)(const float4x4& clip_from_object, const float3* p, std::size_t n, Viewport viewport,
                    ScreenVertex* out);
};

}  // namespace zoneplate
