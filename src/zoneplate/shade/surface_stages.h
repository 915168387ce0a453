#pragma once

#include "zoneplate/shade/geometry_stages.h"
#include "zoneplate/shade/lighting_stages.h"

namespace zoneplate::stages {

/// The stages of shade/surface_kernels.h for one lane type of shade/lanes.h.
template <class F>
constexpr SurfaceKernels all() {
  return {
      .scale = &scale<F>,
      .multiply = &multiply<F>,
      .fill = &fill<F>,
      .saturate = &saturate<F>,
      .interpolate = &interpolate<F>,
      .map_coordinates = &map_coordinates<F>,
      .place_positions = &place_positions<F>,
      .place_normals = &place_normals<F>,
      .place_tangents = &place_tangents<F>,
      .find_normals = &find_normals<F>,
      .bend_normals = &bend_normals<F>,
      .default_normals = &default_normals<F>,
      .light_phong = &light_phong<F>,
      .light_metallic = &light_metallic<F>,
      .unlit = &unlit<F>,
  };
}

}  // namespace zoneplate::stages
