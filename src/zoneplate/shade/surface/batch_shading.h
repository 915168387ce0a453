// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "zoneplate/raster/types/batch.h"
#include "zoneplate/shade/surface/layered.h"
#include "zoneplate/shade/surface/shading_state.h"
#include "zoneplate/shade/surface/surface_constants.h"
#include "zoneplate/shade/texture/filtering.h"

namespace zoneplate {

/// One batch between the stages of its material's plan. The stages of the heights are in heights.cpp.
struct BatchShading {
  const SurfaceConstants& d;
  const MaterialPlan& plan;
  const FragmentBatch& batch;
  const SurfaceKernels& kernels = d.kernels;
  ShadingState p;
  TriangleVertices vertices;
  Coordinates coordinates;
  Taps taps;
  const TextureSlot* taps_of = nullptr;  ///< the slot whose texture look-up made `taps`
  std::unique_ptr<float[]> random;       ///< for stochastic filtering: three numbers of each fragment
  std::unique_ptr<float[]> light_visibility;
  LayerState q;
  bool is_corner = false;  ///< a corner of a triangle, whose fragments sample the textures of the base colour
  alignas(64) float texel_values[4][FragmentBatch::padded_capacity];
  float* const texel[4] = {texel_values[0], texel_values[1], texel_values[2], texel_values[3]};

  BatchShading(const SurfaceConstants& data, const FragmentBatch& of)
      : d(data), plan(data.plans[static_cast<std::size_t>(of.material)]), batch(of) {
    p.count = batch.padded();
  }

  void interpolate(const SurfaceConstants::Needs& needs);
  Footprint footprint(const TextureSlot& slot);
  void evaluate_random();
  void sample(const TextureSlot& slot, float* const out[4]);
  void sample(const TextureSlot& slot, Footprint at, float* const out[4]);
  void displace_coordinates();
  void tilt_normals();
  void widen_roughness();
  void shade_color(FragmentOutputs& out);
  void evaluate_base();
  void apply_solid_texture();
  void evaluate_normals();
  void evaluate_emissive();
  void add_own_ambient();
  void evaluate_occlusion();
  void evaluate_metallic();
  void evaluate_visibility();
  void evaluate_highlight();
  void evaluate_thickness();
  void evaluate_mixed_levels();
  void light_layered(FragmentOutputs& out);
  void light(FragmentOutputs& out);
  void unlit(FragmentOutputs& out);

 private:
  void light_whole(FragmentOutputs& out);
  void evaluate_normals(const TextureSlot& normal_map, float scale);
  void evaluate_coat_normals();
  void flatten_normals();
  void turn_lobes(float scale);
};

}  // namespace zoneplate
