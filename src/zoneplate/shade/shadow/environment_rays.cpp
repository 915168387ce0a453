// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/environment_rays.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/math/basis.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/shadow/disc_samples.h"

namespace zoneplate {
namespace {

/// The luminance of the light from about a direction.
float luminance_from(const EnvironmentView& environment, float3 d) {
  using F = scalar::Float;
  constexpr float roughness = 0.4f;
  const Vector<F> light = specular_light(environment, {F(d.x), F(d.y), F(d.z)}, F(roughness));
  return 0.2126f * light.x.v + 0.7152f * light.y.v + 0.0722f * light.z.v;
}

/// The direction of a point of the square [-1, 1]² onto which the octahedron |x| + |y| + |z| = 1 is unfolded, of any
/// length.
float3 unfolded(float s, float t) {
  const float z = 1 - std::abs(s) - std::abs(t);
  const float fold = std::max(-z, 0.0f);
  return {s - std::copysign(fold, s), t - std::copysign(fold, t), z};
}

}  // namespace

EnvironmentRays::EnvironmentRays(const EnvironmentView& environment) : kernels_(HemisphereKernels::of()) {
  const auto centre = [](int i) { return (2 * static_cast<float>(i) + 1) / side - 1; };
  for (int i = 0; i < side * side; ++i)
    light_[static_cast<std::size_t>(i)] = luminance_from(environment, unfolded(centre(i % side), centre(i / side)));
  const auto [least, greatest] = std::minmax_element(light_.begin(), light_.end());
  is_uniform_ = *greatest - *least <= 1e-3f * *greatest;

  const DirectionsAbout up({0, 0, 1});
  for (int c = 0; c < HemisphereCells::count; ++c) {
    constexpr float whole_turn = 6.28318531f;
    const auto ring = static_cast<float>(c % HemisphereCells::rings);
    const float turn = (static_cast<float>(c / HemisphereCells::rings) + 0.5f) / HemisphereCells::sectors;
    const float3 d =
        up.of_cosine({(ring + 0.5f) / HemisphereCells::rings, cos(whole_turn * turn), sin(whole_turn * turn), 0, 0});
    middle_[0][c] = d.x, middle_[1][c] = d.y, middle_[2][c] = d.z;
  }
}

EnvironmentRays::Hemisphere::Hemisphere(const EnvironmentRays& rays, float3 normal)
    : kernels_(rays.kernels_), frame_{Basis(normal).first, Basis(normal).second, normal} {
  kernels_.look_up(rays.light_.data(), rays.middle_, frame_, light_);
  for (const float sum : light_.sum) all_ += sum;
}

void EnvironmentRays::Hemisphere::begin(std::uint32_t seed, int count) {
  step_ = all_ / static_cast<float>(count);
  turn_ = hash(seed, 0, 2);
  target_ = step_ * unit_float(hash(seed, 0, 1));
  before_ = 0, ring_ = 0;
}

void EnvironmentRays::Hemisphere::next(int number, Directions& directions) {
  HemispherePlaces places{};
  places.count = number;
  for (int i = 0; i < number; ++i) {
    while (ring_ + 1 < HemisphereCells::rings && before_ + light_.sum[ring_] <= target_) before_ += light_.sum[ring_++];
    places.ring[i] = ring_, places.across[i] = target_ - before_, places.turn[i] = unit_float(turn_);
    target_ += step_, turn_ += golden_step;
  }
  kernels_.directions(light_, places, frame_, directions);
}

}  // namespace zoneplate
