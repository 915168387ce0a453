// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/surface/batch_shading.h"
#include "zoneplate/shade/surface/corners.h"
#include "zoneplate/shade/surface/geometry_lanes.h"
#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/texture_view.h"

/// The stages of a batch that read a texture of heights.
namespace zoneplate {

/// Central differences of the heights over a texel of the mip level that is read on each side. The heights' filter
/// makes them the gradient of a surface without detail below a pixel.
void BatchShading::tilt_normals() {
  struct Scratch {
    SurfaceGradients surface;
    alignas(64) ShadingState::Array level, ratio, shifted, low, unused[3], gradient[3];
  };
  const auto scratch = std::make_unique<Scratch>();
  const TextureSlot& slot = plan.slot(TextureSlotIndex::Height);
  const TextureView& heights = slot.texture->view();
  compute_surface_gradients(d.scene, batch, slot.uv_set, scratch->surface);
  const Footprint at = footprint(slot);
  measure_footprints(heights, at, scratch->level, scratch->ratio, p.count);
  for (auto& axis : scratch->gradient) std::fill_n(axis, p.count, 0.0f);
  for (int axis = 0; axis < 2; ++axis) {
    const float* const coordinate = axis == 0 ? at.u : at.v;
    const float spacing = 1 / static_cast<float>(axis == 0 ? heights.width[0] : heights.height[0]);
    const auto step = [&](int i) { return spacing * exp2(std::max(scratch->level[i], 0.0f)); };
    const auto heights_at = [&](float sign, float* out) {
      for (int i = 0; i < p.count; ++i) scratch->shifted[i] = coordinate[i] + sign * step(i);
      Footprint moved = at;
      (axis == 0 ? moved.u : moved.v) = scratch->shifted;
      float* const channels[4] = {out, scratch->unused[0], scratch->unused[1], scratch->unused[2]};
      sample(slot, moved, channels);
    };
    heights_at(-1, scratch->low), heights_at(1, texel_values[0]);
    for (int i = 0; i < p.count; ++i) {
      const float slope = plan.height_scale * (texel_values[0][i] - scratch->low[i]) / (2 * step(i));
      const float along_u = slope * slot.map.m[3 * axis], along_v = slope * slot.map.m[3 * axis + 1];
      for (int c = 0; c < 3; ++c)
        scratch->gradient[c][i] += along_u * scratch->surface.u[c][i] + along_v * scratch->surface.v[c][i];
    }
  }
  taps_of = nullptr;
  const float* const gradient[3] = {scratch->gradient[0], scratch->gradient[1], scratch->gradient[2]};
  kernels.tilt_normals(batch, gradient, p);
}

/// Moves the texture coordinates to where the ray to the viewer meets the heights: the first of equally deep layers
/// below the heights, and from there back to where a line between both layers meets them.
/// Source    Policarpo et al. 2005, Tatarchuk, Dynamic Parallax Occlusion Mapping, I3D 2006.
void BatchShading::displace_coordinates() {
  struct Scratch {
    SurfaceGradients surface;
    alignas(64) ShadingState::Array start[2], slope[2], above, depth, unused[3];
    bool is_found[FragmentBatch::padded_capacity] = {};
  };
  constexpr float min_cosine = 0.05f;  // of the angle at which a ray enters: beyond, it runs along the layers
  const auto scratch = std::make_unique<Scratch>();
  Scratch& s = *scratch;
  const TextureSlot& slot = plan.slot(TextureSlotIndex::Height);
  float *const u = p.uv[slot.uv_set][0], *const v = p.uv[slot.uv_set][1];
  compute_surface_gradients(d.scene, batch, slot.uv_set, s.surface);
  const stages::Viewer<scalar::Float> viewer(d.viewpoint);
  for (int i = 0; i < p.count; ++i) {
    const auto at = [&](const float(&of)[3][FragmentBatch::padded_capacity]) {
      return Vector<scalar::Float>{of[0][i], of[1][i], of[2][i]};
    };
    const auto to_viewer = viewer.direction(batch, p, i);
    const float into = -1 / std::max(dot(to_viewer, at(s.surface.normal)).v, min_cosine);
    s.slope[0][i] = into * dot(to_viewer, at(s.surface.u)).v, s.slope[1][i] = into * dot(to_viewer, at(s.surface.v)).v;
    s.start[0][i] = u[i], s.start[1][i] = v[i], s.above[i] = s.depth[i] = 0;
  }
  const int layers = plan.parallax_layers;
  const float scale = std::abs(plan.height_scale), layer = scale / static_cast<float>(layers);
  for (int n = 0; n <= layers; ++n) {
    const float depth = layer * static_cast<float>(n);
    for (int i = 0; i < p.count; ++i)
      u[i] = s.start[0][i] + depth * s.slope[0][i], v[i] = s.start[1][i] + depth * s.slope[1][i];
    float* const channels[4] = {texel_values[0], s.unused[0], s.unused[1], s.unused[2]};
    sample(slot, footprint(slot), channels);
    bool are_all_found = true;
    for (int i = 0; i < p.count; ++i) {
      if (s.is_found[i]) continue;
      // How far the heights lie below the layer; `above` is that of the layer before.
      const float below = (1 - texel_values[0][i]) * scale - depth;
      if (below <= 0) {
        s.is_found[i] = true;
        const float change = s.above[i] - below;
        s.depth[i] = n == 0 ? 0.0f : depth - layer * (change > 0 ? -below / change : 0.0f);
      } else {
        s.above[i] = below, s.depth[i] = depth;
        are_all_found = false;
      }
    }
    if (are_all_found) break;
  }
  for (int i = 0; i < p.count; ++i) {
    u[i] = s.start[0][i] + s.depth[i] * s.slope[0][i];
    v[i] = s.start[1][i] + s.depth[i] * s.slope[1][i];
  }
  taps_of = nullptr;
}

}  // namespace zoneplate
