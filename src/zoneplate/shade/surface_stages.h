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
      .look_back = &look_back<F>,
      .face_normals = &face_normals<F>,
      .bend_normals = &bend_normals<F>,
      .default_normals = &default_normals<F>,
      .reach_light = &reach_light<F>,
      .add_lambert = &add_lambert<F>,
      .add_blinn_phong = &add_blinn_phong<F>,
      .add_phong = &add_phong<F>,
      .add_metallic = &add_metallic<F>,
      .add_environment = &add_environment<F>,
      .combine_diffuse = &combine_diffuse<F>,
      .add_specular = &add_specular<F>,
      .add_emissive = &add_emissive<F>,
      .keep_unlit = &keep_unlit<F>,
      .finish = &finish<F>,
  };
}

}  // namespace zoneplate::stages
