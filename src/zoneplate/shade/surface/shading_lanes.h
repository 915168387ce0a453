// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/shade/surface/geometry_lanes.h"
#include "zoneplate/shade/surface/layered_lanes.h"
#include "zoneplate/shade/surface/light_component_lanes.h"
#include "zoneplate/shade/surface/lighting_lanes.h"
#include "zoneplate/shade/surface/normals_lanes.h"

namespace zoneplate::stages {

/// The stages of shade/surface/shading.h for one lane type of math/lanes.h.
template <class F, class Wide>
constexpr SurfaceKernels all() {
  return {
      .scale = &scale<Wide>,
      .multiply = &multiply<Wide>,
      .fill = &fill<Wide>,
      .saturate = &saturate<Wide>,
      .interpolate = &interpolate<F, Wide>,
      .map_coordinates = &map_coordinates<F>,
      .transform_positions = &transform_positions<F>,
      .transform_normals = &transform_normals<F>,
      .transform_tangents = &transform_tangents<F>,
      .compute_normals = &compute_normals<F>,
      .bend_normals = &bend_normals<F>,
      .compute_normal_variance = &compute_normal_variance<F>,
      .widen_roughness = &widen_roughness<F>,
      .tilt_normals = &tilt_normals<F>,
      .default_normals = &default_normals<F>,
      .light_phong = &light_phong<Wide>,
      .light_metallic = &light_metallic<Wide>,
      .light_metallic_in_map = &light_metallic_in_map<Wide>,
      .light_layered = &light_layered<F, Wide>,
      .keep_component = &keep_component<F>,
      .unlit = &unlit<Wide>,
  };
}

}  // namespace zoneplate::stages
