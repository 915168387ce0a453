// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/traced_visibility.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
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

/// The number of rays of receiver i.
int number_of(int rays, const Receivers& receivers, int i) {
  return Receivers::halved(rays, receivers.halvings == nullptr ? 0 : receivers.halvings[i]);
}

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
      kernels_(RayKernels::of()) {
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    if (lights_[k].kind != LightKind::Directional) continue;
    const float angle = lights_[k].radius > 0 ? lights_[k].radius : shadows.angle;
    seen_[k] = {-normalize(lights_[k].direction, {0, 0, -1}), std::numeric_limits<float>::infinity(),
                height_of(sin(std::min(angle, 1.57079633f)))};
  }
  if (environment != nullptr && occlusion.samples > 0) environment_.emplace(*environment);
  if (environment_ && environment_->is_uniform()) environment_.reset();
  for (int rays = occlusion.samples; !environment_; rays = (rays + 1) / 2) {
    hemispheres_.emplace_back(rays);
    if (rays <= Receivers::min_rays) break;
  }
}

TracedVisibility::SeenLight TracedVisibility::see(std::size_t k, float3 from) const {
  const Light& light = lights_[k];
  if (light.kind == LightKind::Directional) return seen_[k];
  const float3 path = light.position - from;
  const float distance = length(path);
  const float sine = light.radius > 0 ? light.radius / std::max(distance, light.radius) : sine_of_angle_;
  return {normalize(path, {0, 0, 1}), distance, height_of(sine)};
}

/// The mean over rays ray(i, 0), ray(i, 1), ... of what each of them sees, for receivers i. The first quarter of all
/// rays, also where fewer are traced, are the only ones where all of these see the same. Rays of successive receivers
/// are traced together.
template <class MakeRay>
void TracedVisibility::compute_means(const Receivers& receivers, std::span<const int> which, const MakeRay& ray,
                                     float* visible) const {
  struct Sum {
    float all = 0, least = 1, greatest = 0;
    bool is_even() const { return least == greatest && (least == 0 || least == 1); }
  };
  Sum sums[Receivers::capacity];
  const auto samples_of = [&](int i) { return number_of(shadows_.samples, receivers, i); };
  const auto trace = [&](std::span<const int> some, int first, int end) {
    Ray rays[chunk];
    int from[chunk];
    float seen[chunk];
    int count = 0;
    const auto add = [&] {
      kernels_.visibility(bvh_, rays, static_cast<std::size_t>(count), opacity_, seen);
      for (int n = 0; n < count; ++n) {
        Sum& sum = sums[from[n]];
        sum.all += seen[n];
        sum.least = std::min(sum.least, seen[n]), sum.greatest = std::max(sum.greatest, seen[n]);
      }
      count = 0;
    };
    for (const int i : some) {
      const auto of_receiver = ray(i);
      const int last = std::min(end, samples_of(i));
      for (int s = first; s < last; ++s) {
        from[count] = i, rays[count++] = of_receiver(static_cast<std::uint32_t>(s));
        if (count == chunk) add();
      }
    }
    add();
  };
  const int probes = std::max(1, shadows_.samples / 4);
  trace(which, 0, probes);
  int uneven[Receivers::capacity];
  std::size_t count = 0;
  for (const int i : which) {
    if (!sums[i].is_even()) uneven[count++] = i;
    visible[i] = sums[i].least;
  }
  trace({uneven, count}, probes, shadows_.samples);
  for (std::size_t n = 0; n < count; ++n)
    visible[uneven[n]] = sums[uneven[n]].all / static_cast<float>(samples_of(uneven[n]));
}

bool TracedVisibility::is_lit(int k, const Receivers& receivers, int i) const {
  const SeenLight seen = see(static_cast<std::size_t>(k), origin_of(receivers, i, 1));
  return dot(at(receivers.normal, i), seen.direction) > 0;
}

void TracedVisibility::of_light(int k, const Receivers& receivers, float* visible) const {
  if (shadows_.method == ShadowMethod::None) return std::fill_n(visible, receivers.count, 1.0f), void();
  const Light& light = lights_[static_cast<std::size_t>(k)];
  int lit[Receivers::capacity];
  float3 origins[Receivers::capacity];
  SeenLight seen[Receivers::capacity];
  int count = 0;
  for (int i = 0; i < receivers.count; ++i) {
    origins[i] = origin_of(receivers, i, 1);
    seen[i] = see(static_cast<std::size_t>(k), origins[i]);
    visible[i] = 0;
    if (!(dot(at(receivers.normal, i), seen[i].direction) > 0)) {
      if (!receivers.is_transmissive) continue;
      origins[i] = origin_of(receivers, i, -1);
    }
    lit[count++] = i;
  }
  const std::span<const int> which{lit, static_cast<std::size_t>(count)};
  if (shadows_.method == ShadowMethod::Hard) {
    Ray rays[Receivers::capacity];
    float found[Receivers::capacity];
    const bool is_far = light.kind == LightKind::Directional;
    for (std::size_t n = 0; n < which.size(); ++n) {
      const int i = which[n];
      rays[n] = is_far ? make_ray(origins[i], seen[i].direction, seen[i].distance)
                       : make_ray(origins[i], light.position - origins[i], 1);
    }
    kernels_.visibility(bvh_, rays, which.size(), opacity_, found);
    for (std::size_t n = 0; n < which.size(); ++n) visible[which[n]] = found[n];
    return;
  }
  const auto ray = [&](int i) {
    return [&, i, disc = ShiftedDisc(lattice_, receivers.seed[i], static_cast<std::uint32_t>(k) + 1),
            directions = DirectionsAbout(seen[i].direction)](std::uint32_t s) {
      const ShiftedDisc::Point p = disc(s);
      return make_ray(origins[i] + at(receivers.dx, i) * p.x + at(receivers.dy, i) * p.y,
                      directions.of_cone(p, seen[i].height), seen[i].distance);
    };
  };
  compute_means(receivers, which, ray, visible);
}

/// The mean over directions of a density proportional to the cosine.
float TracedVisibility::of_uniform_light(const Receivers& receivers, int i, float3 origin, const BvhTop& top) const {
  const DirectionsAbout directions(at(receivers.normal, i));
  const auto see = [&](const ShiftedDisc::Point* points, int count, float* visible) {
    Ray rays[AdaptiveDisc::max_points];
    for (int s = 0; s < count; ++s) rays[s] = make_ray(origin, directions.of_cosine(points[s]), occlusion_.distance);
    kernels_.visibility_below(bvh_, top, rays, static_cast<std::size_t>(count), opacity_, visible);
  };
  const auto halvings = static_cast<std::size_t>(receivers.halvings == nullptr ? 0 : receivers.halvings[i]);
  return hemispheres_[std::min(halvings, hemispheres_.size() - 1)].mean(receivers.seed[i], std::ref(see));
}

/// The mean over equal parts of the environment's irradiance.
float TracedVisibility::of_rays(EnvironmentRays::Hemisphere& light, const Receivers& receivers, int i, float3 origin,
                                const BvhTop& top) const {
  Ray rays[chunk];
  float seen[chunk];
  if (!light.is_lit() || top.count == 0) return 1;
  const int samples = number_of(occlusion_.samples, receivers, i);
  light.begin(receivers.seed[i], samples);
  float sum = 0;
  for (int first = 0; first < samples; first += chunk) {
    const int count = std::min(chunk, samples - first);
    EnvironmentRays::Hemisphere::Directions d;
    light.next(count, d);
    for (int s = 0; s < count; ++s) rays[s] = make_ray(origin, {d[0][s], d[1][s], d[2][s]}, occlusion_.distance);
    kernels_.visibility_below(bvh_, top, rays, static_cast<std::size_t>(count), opacity_, seen);
    for (int s = 0; s < count; ++s) sum += seen[s];
  }
  return sum / static_cast<float>(samples);
}

void TracedVisibility::of_environment(const Receivers& receivers, float* visible) const {
  std::optional<EnvironmentRays::Hemisphere> light;
  for (int i = 0; i < receivers.count; ++i) {
    const float3 origin = origin_of(receivers, i, 1), normal = at(receivers.normal, i);
    visible[i] = 1;
    if (distance_squared(bounds_, origin) > occlusion_.distance * occlusion_.distance) continue;
    BvhTop top;
    kernels_.collect_top(bvh_, {{origin.x, origin.y, origin.z}, {normal.x, normal.y, normal.z}, occlusion_.distance},
                         top);
    if (!environment_) {
      visible[i] = of_uniform_light(receivers, i, origin, top);
      continue;
    }
    // The neighbours on a plane have the same normal.
    if (!light || !light->is_about(normal)) light.emplace(*environment_, normal);
    visible[i] = of_rays(*light, receivers, i, origin, top);
  }
}

}  // namespace zoneplate
