// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/surface/geometry_lanes.h"

/// The stages of shade/surface/shading.h about the variance and the bumps of normals, over the lane types of
/// math/lanes.h.
namespace zoneplate::stages {

template <class F>
void compute_normal_variance(const FragmentBatch& batch, const TriangleVertices& vertices,
                             const InstanceTransform* transforms, ShadingState& p) {
  constexpr float variance = 1.0f / 12;  // of a coordinate in a pixel
  constexpr float most = 0.09f;          // beyond, silhouettes would become matte
  for (int c = 0; c < 3; ++c) {
    fill_repeated(batch, p.count, p.normal_dx[c]);
    fill_repeated(batch, p.count, p.normal_dy[c]);
  }
  for (int i = 0; i < p.count; i += F::lanes) {
    const Vector<F> n = transformed(batch, vertices, transforms->normal, Vector<F>::load(p.normal, i), i);
    const F square = dot(n, n), inverse = select(square > F(1e-36f), F(1.0f) / square, F(0.0f));
    // The derivative of n / |n| is that of n, without its part along n, over |n|.
    const F length = sqrt(inverse);
    const auto change = [&](const ShadingState::Array(&of)[3]) {
      const Vector<F> d = transformed(batch, vertices, transforms->normal, Vector<F>::load(of, i), i);
      return (d - n * (dot(n, d) * inverse)) * length;
    };
    const Vector<F> dx = change(p.normal_dx), dy = change(p.normal_dy);
    const F sum = F(variance) * (dot(dx, dx) + dot(dy, dy)), bounded = min(sum, F(most));
    bounded.store(p.normal_variance + i);
    const F scale = sqrt(F(2 * variance) * select(sum > F(most), bounded / sum, F(1.0f)));
    (dx * scale).store(p.normal_dx, i), (dy * scale).store(p.normal_dy, i);
  }
}

/// The roughness of a lobe whose α² is greater by a variance.
template <class F>
[[gnu::always_inline]] inline F widened(F roughness, F variance) {
  const F r = max(roughness, F(min_roughness)), alpha = r * r;
  return sqrt(sqrt(min(alpha * alpha + variance, F(1.0f))));
}

template <class F>
void widen_roughness(ShadingState& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    widened(F::load(p.roughness + i), F::load(p.normal_variance + i)).store(p.roughness + i);
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
