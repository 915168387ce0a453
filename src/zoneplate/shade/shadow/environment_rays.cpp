// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/environment_rays.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/environment/lookup_lanes.h"

namespace zoneplate {
namespace {

constexpr float whole_turn = 6.28318531f;

/// The luminance of the light from about a direction.
float luminance_from(const EnvironmentView& environment, float3 d) {
  using F = scalar::Float;
  constexpr float roughness = 0.4f;
  const Vector<F> light = specular_light(environment, {F(d.x), F(d.y), F(d.z)}, F(roughness));
  return 0.2126f * light.x.v + 0.7152f * light.y.v + 0.0722f * light.z.v;
}

/// The point of a disc at a turn and the square of a radius.
ShiftedDisc::Point disc_point(float square, float turn) {
  return {std::min(square, 1.0f), cos(whole_turn * turn), sin(whole_turn * turn), 0, 0};
}

/// The direction of a point of the square [-1, 1]² onto which the octahedron |x| + |y| + |z| = 1 is unfolded, of any
/// length.
float3 unfolded(float s, float t) {
  const float z = 1 - std::abs(s) - std::abs(t);
  const float fold = std::max(-z, 0.0f);
  return {s - std::copysign(fold, s), t - std::copysign(fold, t), z};
}

/// The number of the cell, of side × side, in which a direction meets that square. Edges: of no number, the last one.
inline std::int32_t folded(float3 d, int side) {
  const float inverse = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  const float s = d.x * inverse, t = d.y * inverse;
  const float fold = std::max(-d.z * inverse, 0.0f);
  const float scale = 0.5f * static_cast<float>(side);
  const auto index = [&](float x) {
    return static_cast<std::int32_t>(std::min(2 * scale - 1, (x + std::copysign(fold, x) + 1) * scale));
  };
  return index(t) * side + index(s);
}

}  // namespace

EnvironmentRays::EnvironmentRays(const EnvironmentView& environment) {
  const auto centre = [](int i) { return (2 * static_cast<float>(i) + 1) / side - 1; };
  for (int i = 0; i < side * side; ++i)
    light_[static_cast<std::size_t>(i)] = luminance_from(environment, unfolded(centre(i % side), centre(i / side)));
  const auto [least, greatest] = std::minmax_element(light_.begin(), light_.end());
  is_uniform_ = *greatest - *least <= 1e-3f * *greatest;

  const DirectionsAbout up({0, 0, 1});
  for (std::size_t c = 0; c < cells; ++c) {
    const auto ring = static_cast<float>(c / sectors), sector = static_cast<float>(c % sectors);
    const float3 d = up.of_cosine(disc_point((ring + 0.5f) / rings, (sector + 0.5f) / sectors));
    middle_[0][c] = d.x, middle_[1][c] = d.y, middle_[2][c] = d.z;
  }
}

EnvironmentRays::Hemisphere::Hemisphere(const EnvironmentRays& rays, float3 normal, int count) : directions_(normal) {
  const auto& [x, y, z] = rays.middle_;
  std::int32_t cell[cells];
  for (std::size_t c = 0; c < cells; ++c) cell[c] = folded(directions_.turned({x[c], y[c], z[c]}), side);
  for (std::size_t c = 0; c < cells; ++c) light_[c] = rays.light_[static_cast<std::size_t>(cell[c])];
  float all = 0;
  for (std::size_t r = 0; r < rings; ++r) {
    float sum = 0;
    for (std::size_t s = 0; s < sectors; ++s) sum += light_[r * sectors + s];
    all += sum_[r] = sum;
  }
  step_ = all / static_cast<float>(count);
}

void EnvironmentRays::Hemisphere::begin(std::uint32_t seed) {
  turn_ = hash(seed, 0, 2);
  target_ = step_ * unit_float(hash(seed, 0, 1));
  before_ = 0, ring_ = 0;
}

float3 EnvironmentRays::Hemisphere::next() {
  while (ring_ + 1 < rings && before_ + sum_[ring_] <= target_) before_ += sum_[ring_++];
  // By rounding, the last of the targets may lie behind the last ring with light.
  const float sum = sum_[ring_], across = sum > 0 ? std::clamp((target_ - before_) / sum, 0.0f, 1.0f) : 0.5f;
  float along = unit_float(turn_) * sum_[ring_];
  target_ += step_, turn_ += golden_step;

  const float* const light = light_.data() + ring_ * sectors;
  std::size_t sector = 0;
  while (sector + 1 < sectors && light[sector] <= along) along -= light[sector++];
  const float within = light[sector] > 0 ? std::min(along / light[sector], 1.0f) : 0.5f;
  return directions_.of_cosine(
      disc_point((static_cast<float>(ring_) + across) / rings, (static_cast<float>(sector) + within) / sectors));
}

}  // namespace zoneplate
