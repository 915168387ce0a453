// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/smooth_sums.h"

#include <atomic>
#include <cmath>
#include <limits>

#include "zoneplate/math/vec.h"

namespace zoneplate::scalar {
namespace {

using K = SmoothSumKernels;

float3 at(const float* list, std::uint32_t v) {
  const float* const p = list + std::size_t{3} * v;
  return {p[0], p[1], p[2]};
}

struct Edges {
  float3 ab, ac, bc;
};
Edges edges_of(const float* position, const std::uint32_t* v) {
  const float3 a = at(position, v[0]), b = at(position, v[1]), c = at(position, v[2]);
  return {b - a, c - a, c - b};
}

void add(const float* position, std::size_t, const std::uint32_t* index, std::size_t triangles, VertexRange own,
         float* sum) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::uint32_t* v = index; v != index + 3 * triangles; v += 3) {
    const Edges e = edges_of(position, v);
    const float3 area = cross(e.ab, e.ac);
    const float square = dot(area, area), ab = dot(e.ab, e.ab), ac = dot(e.ac, e.ac), bc = dot(e.bc, e.bc);
    const float products[3] = {ab * ac, ab * bc, ac * bc};
    bool is_sound = square > K::thin * products[0];
    for (const float p : products) is_sound = is_sound && p > K::min_square && p < K::max_square;
    for (std::size_t k = 0; k < 3; ++k) {
      if (v[k] - own.begin >= own.size) continue;
      const float share = (is_sound ? 1 : nan) / products[k];
      float* const s = sum + std::size_t{3} * v[k];
      s[0] += area.x * share, s[1] += area.y * share, s[2] += area.z * share;
    }
  }
}

void normalize(float* sum, std::size_t count, char* mark) {
  for (std::size_t v = 0; v < count; ++v) {
    float* const n = sum + 3 * v;
    const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], scale = 1 / std::sqrt(square);
    const bool is_sound = square > K::min_square && square < K::max_square;
    if (!is_sound) mark[v] = 1;
    n[0] = is_sound ? n[0] * scale : 0, n[1] = is_sound ? n[1] * scale : 1, n[2] = is_sound ? n[2] * scale : 0;
  }
}

void mark_turns(const float* position, const float* normal, std::size_t, const std::uint32_t* index,
                std::size_t triangles, char* mark) {
  for (const std::uint32_t* v = index; v != index + 3 * triangles; v += 3) {
    const Edges e = edges_of(position, v);
    const float3 area = cross(e.ab, e.ac);
    const float least = K::cos_25_squared * dot(area, area);
    for (std::size_t k = 0; k < 3; ++k) {
      const float along = dot(at(normal, v[k]), area);
      if (!(along > 0 && along * along > least)) std::atomic_ref(mark[v[k]]).store(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const SmoothSumKernels PerIsa<SmoothSumKernels>::scalar = {
    .add = scalar::add, .normalize = scalar::normalize, .mark_turns = scalar::mark_turns};

}  // namespace zoneplate
