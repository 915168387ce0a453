// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/surface/geometry_lanes.h"

/// The stages of shade/surface/shading.h about the variance and the bumps of normals, over the lane types of
/// math/lanes.h.
namespace zoneplate::stages {

template <class F>
void find_normal_variance(const FragmentBatch& batch, const TriangleVertices& vertices,
                          const InstanceTransform* transforms, ShadingState& p) {
  constexpr float variance = 1.0f / 12;  // of a coordinate in a pixel
  constexpr float most = 0.18f;          // beyond, silhouettes would become matte
  for (int c = 0; c < 3; ++c) {
    fill_repeated(batch, p.count, p.normal_dx[c]);
    fill_repeated(batch, p.count, p.normal_dy[c]);
  }
  for (int i = 0; i < p.count; i += F::lanes) {
    const Vector<F> n = transformed(batch, vertices, transforms->normal, Vector<F>::load(p.normal, i), i);
    const F square = dot(n, n), inverse = select(square > F(1e-36f), F(1.0f) / square, F(0.0f));
    // The derivative of n / |n| is that of n, without its part along n, over |n|.
    const auto change = [&](const ShadingState::Array(&of)[3]) {
      const Vector<F> d = transformed(batch, vertices, transforms->normal, Vector<F>::load(of, i), i);
      const F along = dot(n, d);
      return max((dot(d, d) - along * along * inverse) * inverse, F(0.0f));
    };
    min(F(variance) * (change(p.normal_dx) + change(p.normal_dy)), F(most)).store(p.normal_variance + i);
  }
}

template <class F>
void widen_roughness(ShadingState& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const F r = max(F::load(p.roughness + i), F(least_roughness)), alpha = r * r;
    sqrt(sqrt(min(alpha * alpha + F::load(p.normal_variance + i), F(1.0f)))).store(p.roughness + i);
  }
}

template <class F>
void tilt_normals(const FragmentBatch& batch, const float* const gradient[3], ShadingState& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), g = Vector<F>::load(gradient, i);
    const Vector<F> tilted = normalize(n - (g - n * dot(n, g)) * facing<F>(batch, i));
    select(dot(tilted, tilted) > F(0.5f), tilted, n).store(p.normal, i);
  }
}

}  // namespace zoneplate::stages
