// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/environment/level_mix.h"
#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/surface/shading.h"
#include "zoneplate/shade/surface/surface.h"
#include "zoneplate/shade/surface/vertices.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/solid_texture.h"

namespace zoneplate {

/// What all batches of an image share: the scene, the plans of its materials, and the kernels that run them.
struct SurfaceConstants {
  /// The arguments must outlive the constants.
  SurfaceConstants(const Scene& scene, const ViewUniforms& view, const TextureSet& textures,
                   const InterleavedVertices& records);

  /// The vertex attributes that fragments need, and their interpolation.
  struct Needs {
    Attributes attributes;
    Interpolation interpolation;
  };

  /// The direction to the viewer may require the fragments' positions.
  Needs make_needs(int material, Attributes attributes, bool needs_viewer) const;

  /// The mixes of the environment's levels for a material's lobes; null where their roughness differs between
  /// fragments.
  struct Lobes {
    LevelMix* base = nullptr;
    LevelMix* coat = nullptr;
  };
  Lobes make_lobes(const MaterialPlan& plan, const ShadingUniforms& uniforms);

  const Scene& scene;
  const ViewUniforms view;
  const InterleavedVertices& records;
  const std::vector<MaterialPlan> plans;
  const std::vector<InstanceTransform> transforms;
  const std::vector<PreparedLight> lights;
  const Viewpoint viewpoint;
  const SurfaceKernels& kernels;
  const FilteringKernels& filtering;
  const SolidTextureKernels& solid;
  std::vector<ShadingUniforms> shading_uniforms;     ///< by material
  std::vector<Needs> needs_of_color;                 ///< by material
  std::vector<Lobes> lobes;                          ///< by material
  std::map<float, std::unique_ptr<LevelMix>> mixes;  ///< by roughness
};

}  // namespace zoneplate
