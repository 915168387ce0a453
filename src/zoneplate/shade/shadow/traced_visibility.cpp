// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/traced_visibility.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

float3 at(const float (&array)[3][Receivers::capacity], int i) { return {array[0][i], array[1][i], array[2][i]}; }

/// Where the rays of a receiver begin, on the side of its face (1) or on the other one (-1).
float3 origin_of(const Receivers& r, int i, float side) {
  return at(r.position, i) + at(r.face, i) * (side * r.margin[i]);
}

Ray make_ray(float3 origin, float3 direction, float end) {
  return {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, end};
}

/// Rays that are traced together.
constexpr int chunk = HemispherePlaces::capacity;

/// 1 - cos of the angle, without cancellation.
float height_of(float sine) { return sine * sine / (1 + std::sqrt(std::max(0.0f, 1 - sine * sine))); }

/// From a point to the nearest one of a box.
float distance_squared(const Box& box, float3 p) {
  const auto outside = [](float low, float high, float x) { return std::max({low - x, x - high, 0.0f}); };
  const float3 d{outside(box.low.x, box.high.x, p.x), outside(box.low.y, box.high.y, p.y),
                 outside(box.low.z, box.high.z, p.z)};
  return dot(d, d);
}

}  // namespace

TracedVisibility::TracedVisibility(const Bvh& bvh, const OpacityOfHits& opacity, std::vector<Light> lights,
                                   const ShadowOptions& shadows, const OcclusionOptions& occlusion,
                                   const EnvironmentView* environment)
    : bvh_(view_of(bvh)),
      bounds_(bvh.bounds()),
      opacity_(opacity),
      lights_(std::move(lights)),
      seen_(lights_.size()),
      sine_of_angle_(sin(shadows.angle)),
      shadows_(shadows),
      occlusion_(occlusion),
      lattice_(shadows.method == ShadowMethod::Soft ? shadows.samples : 0),
      hemisphere_(occlusion.samples),
      kernels_(RayKernels::of()) {
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    if (lights_[k].kind != LightKind::Directional) continue;
    const float angle = lights_[k].radius > 0 ? lights_[k].radius : shadows.angle;
    seen_[k] = {-normalize(lights_[k].direction, {0, 0, -1}), std::numeric_limits<float>::infinity(),
                height_of(sin(std::min(angle, 1.57079633f)))};
  }
  if (environment != nullptr && occlusion.samples > 0) environment_.emplace(*environment);
  if (environment_ && environment_->is_uniform()) environment_.reset();
}

TracedVisibility::SeenLight TracedVisibility::see(std::size_t k, float3 from) const {
  const Light& light = lights_[k];
  if (light.kind == LightKind::Directional) return seen_[k];
  const float3 path = light.position - from;
  const float distance = length(path);
  const float sine = light.radius > 0 ? light.radius / std::max(distance, light.radius) : sine_of_angle_;
  return {normalize(path, {0, 0, 1}), distance, height_of(sine)};
}

/// The mean over rays ray(0), ray(1), ... of what each of them sees. The first quarter of the rays are the only ones
/// where all of these see the same.
template <class MakeRay>
float TracedVisibility::mean_visibility(const MakeRay& ray) const {
  Ray rays[chunk];
  float visible[chunk];
  float sum = 0, least = 1, greatest = 0;
  const int samples = shadows_.samples, probes = std::max(1, samples / 4);
  for (int first = 0; first < samples;) {
    const int count = std::min(chunk, (first < probes ? probes : samples) - first);
    for (int i = 0; i < count; ++i) rays[i] = ray(static_cast<std::uint32_t>(first + i));
    kernels_.visibility(bvh_, rays, static_cast<std::size_t>(count), opacity_, visible);
    for (int i = 0; i < count; ++i) {
      sum += visible[i];
      least = std::min(least, visible[i]), greatest = std::max(greatest, visible[i]);
    }
    first += count;
    if (first == probes && least == greatest && (least == 0 || least == 1)) return least;
  }
  return sum / static_cast<float>(samples);
}

bool TracedVisibility::is_lit(int k, const Receivers& receivers, int i) const {
  const SeenLight seen = see(static_cast<std::size_t>(k), origin_of(receivers, i, 1));
  return dot(at(receivers.normal, i), seen.direction) > 0;
}

void TracedVisibility::of_light(int k, const Receivers& receivers, float* visible) const {
  if (shadows_.method == ShadowMethod::None) return std::fill_n(visible, receivers.count, 1.0f), void();
  const Light& light = lights_[static_cast<std::size_t>(k)];
  Ray rays[Receivers::capacity];
  int lit[Receivers::capacity];
  int count = 0;
  for (int i = 0; i < receivers.count; ++i) {
    float3 origin = origin_of(receivers, i, 1);
    const SeenLight seen = see(static_cast<std::size_t>(k), origin);
    visible[i] = 0;
    if (!(dot(at(receivers.normal, i), seen.direction) > 0)) {
      if (!receivers.is_transmissive) continue;
      origin = origin_of(receivers, i, -1);
    }
    if (shadows_.method == ShadowMethod::Hard) {
      const bool is_far = light.kind == LightKind::Directional;
      rays[count] =
          is_far ? make_ray(origin, seen.direction, seen.distance) : make_ray(origin, light.position - origin, 1);
      lit[count++] = i;
      continue;
    }
    const ShiftedDisc disc(lattice_, receivers.seed[i], static_cast<std::uint32_t>(k) + 1);
    const DirectionsAbout directions(seen.direction);
    const float3 dx = at(receivers.dx, i), dy = at(receivers.dy, i);
    visible[i] = mean_visibility([&](std::uint32_t s) {
      const ShiftedDisc::Point p = disc(s);
      return make_ray(origin + dx * p.x + dy * p.y, directions.of_cone(p, seen.height), seen.distance);
    });
  }
  float seen[Receivers::capacity];
  kernels_.visibility(bvh_, rays, static_cast<std::size_t>(count), opacity_, seen);
  for (int i = 0; i < count; ++i) visible[lit[i]] = seen[i];
}

/// The mean over directions of a density proportional to the cosine.
float TracedVisibility::of_uniform_light(const Receivers& receivers, int i, float3 origin, const BvhTop& top) const {
  const DirectionsAbout directions(at(receivers.normal, i));
  const auto see = [&](const ShiftedDisc::Point* points, int count, float* visible) {
    Ray rays[AdaptiveDisc::max_points];
    for (int s = 0; s < count; ++s) rays[s] = make_ray(origin, directions.of_cosine(points[s]), occlusion_.distance);
    kernels_.visibility_below(bvh_, top, rays, static_cast<std::size_t>(count), opacity_, visible);
  };
  return hemisphere_.mean(receivers.seed[i], std::ref(see));
}

/// The mean over equal parts of the environment's irradiance.
float TracedVisibility::of_rays(EnvironmentRays::Hemisphere& light, std::uint32_t seed, float3 origin,
                                const BvhTop& top) const {
  Ray rays[chunk];
  float seen[chunk];
  if (!light.is_lit() || top.count == 0) return 1;
  light.begin(seed);
  float sum = 0;
  for (int first = 0; first < occlusion_.samples; first += chunk) {
    const int count = std::min(chunk, occlusion_.samples - first);
    EnvironmentRays::Hemisphere::Directions d;
    light.next(count, d);
    for (int s = 0; s < count; ++s) rays[s] = make_ray(origin, {d[0][s], d[1][s], d[2][s]}, occlusion_.distance);
    kernels_.visibility_below(bvh_, top, rays, static_cast<std::size_t>(count), opacity_, seen);
    for (int s = 0; s < count; ++s) sum += seen[s];
  }
  return sum / static_cast<float>(occlusion_.samples);
}

void TracedVisibility::of_environment(const Receivers& receivers, float* visible) const {
  std::optional<EnvironmentRays::Hemisphere> light;
  for (int i = 0; i < receivers.count; ++i) {
    const float3 origin = origin_of(receivers, i, 1), normal = at(receivers.normal, i);
    visible[i] = 1;
    if (distance_squared(bounds_, origin) > occlusion_.distance * occlusion_.distance) continue;
    BvhTop top;
    kernels_.find_top(bvh_, {{origin.x, origin.y, origin.z}, {normal.x, normal.y, normal.z}, occlusion_.distance}, top);
    if (!environment_) {
      visible[i] = of_uniform_light(receivers, i, origin, top);
      continue;
    }
    // The neighbours on a plane have the same normal.
    if (!light || !light->is_about(normal)) light.emplace(*environment_, normal, occlusion_.samples);
    visible[i] = of_rays(*light, receivers.seed[i], origin, top);
  }
}

}  // namespace zoneplate
