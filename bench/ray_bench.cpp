// SPDX-License-Identifier: Apache-2.0
// Speed of building a BVH and of rays against it, on one thread, beside Embree (robust mode; single rays and packets)
// where it is installed: nanoseconds a ray. Primary rays go from an eye through the pixels of an image row by row;
// shadow rays from what those hit towards a light; occlusion rays from there into the hemisphere, at most as far as a
// third of the model, one from each point, or 64 from every 64th.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/ray/casters_for_test.h"
#include "zoneplate/ray/trace.h"
#ifdef ZONEPLATE_EMBREE
#include "zoneplate/ray/embree_for_test.h"
#endif

namespace zoneplate {
namespace {

struct RayScene {
  TestMesh mesh;
  Bvh bvh;
  std::vector<Ray> primary, shadow, occlusion, hemispheres;

  explicit RayScene(std::uint32_t n) : mesh(bumpy_sphere(n)), bvh(std::vector{mesh.caster()}) {
    constexpr int size = 256;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const float step = 1.3f / size;
        primary.push_back(
            {{0, 0, 3},
             {step * (static_cast<float>(x) - size / 2) / 1.5f, step * (static_cast<float>(y) - size / 2) / 1.5f, -1}});
      }
    std::vector<RayHit> hits(primary.size());
    RayKernels::of().nearest(view_of(bvh), primary.data(), primary.size(), hits.data());
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (hits[i].primitive == RayHit::none) continue;
      const auto p = [&](std::size_t k) { return mesh.position[mesh.index[3 * hits[i].primitive + k]]; };
      float3 normal = normalize(cross(p(1) - p(0), p(2) - p(0)));
      const Ray& ray = primary[i];
      if (dot(normal, {ray.direction[0], ray.direction[1], ray.direction[2]}) > 0) normal = -normal;
      const float3 at = p(0) * (1 - hits[i].b1 - hits[i].b2) + p(1) * hits[i].b1 + p(2) * hits[i].b2 + normal * 1e-5f;
      const float3 to_light = float3{3, 2, 1.5f} - at;
      shadow.push_back({{at.x, at.y, at.z}, {to_light.x, to_light.y, to_light.z}, 1});
      const auto occluded = [&](std::uint32_t k) -> Ray {
        const float4 r = random_numbers(static_cast<std::uint32_t>(i), 77 + k);
        const float3 sphere = normalize(float3{2 * r.x - 1, 2 * r.y - 1, 2 * r.z - 1});
        const float3 d = normalize(normal + sphere * 0.999f);
        return {{at.x, at.y, at.z}, {d.x, d.y, d.z}, 0.7f};
      };
      occlusion.push_back(occluded(0));
      for (std::uint32_t k = 0; k < 64 && i % 64 == 0; ++k) hemispheres.push_back(occluded(k));
    }
  }
};

const RayScene& scene(std::int64_t n) {
  static const RayScene small(170), large(708);
  return n == 170 ? small : large;
}

void per_ray(benchmark::State& state, std::size_t rays) {
  state.counters["ray"] = benchmark::Counter(
      static_cast<double>(rays), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void build(benchmark::State& state) {
  const TestMesh& mesh = scene(state.range(0)).mesh;
  with_threads(1, [&] {
    for (auto _ : state) benchmark::DoNotOptimize(Bvh(std::vector{mesh.caster()}).nodes().data());
  });
}
BENCHMARK(build)->Arg(170)->Arg(708)->Unit(benchmark::kMillisecond);

void nearest_primary(benchmark::State& state) {
  const RayScene& s = scene(state.range(0));
  std::vector<RayHit> hits(s.primary.size());
  for (auto _ : state) RayKernels::of().nearest(view_of(s.bvh), s.primary.data(), s.primary.size(), hits.data());
  per_ray(state, s.primary.size());
}
BENCHMARK(nearest_primary)->Arg(170)->Arg(708);

void time_visibility(benchmark::State& state, const Bvh& bvh, const std::vector<Ray>& rays) {
  std::vector<float> visible(rays.size());
  for (auto _ : state) RayKernels::of().visibility(view_of(bvh), rays.data(), rays.size(), {}, visible.data());
  per_ray(state, rays.size());
}
void visibility_shadow(benchmark::State& state) {
  time_visibility(state, scene(state.range(0)).bvh, scene(state.range(0)).shadow);
}
BENCHMARK(visibility_shadow)->Arg(170)->Arg(708);
void visibility_occlusion(benchmark::State& state) {
  time_visibility(state, scene(state.range(0)).bvh, scene(state.range(0)).occlusion);
}
BENCHMARK(visibility_occlusion)->Arg(170)->Arg(708);

void visibility_hemispheres(benchmark::State& state) {
  time_visibility(state, scene(state.range(0)).bvh, scene(state.range(0)).hemispheres);
}
BENCHMARK(visibility_hemispheres)->Arg(170)->Arg(708);

/// The same rays against one tree that is placed eight times, far from each other.
void placed_hemispheres(benchmark::State& state) {
  const RayScene& s = scene(state.range(0));
  std::vector<ShadowCaster> casters(8, s.mesh.caster());
  for (std::size_t i = 0; i < casters.size(); ++i)
    casters[i].world_from_object.column[3].x = 10 * static_cast<float>(i);
  time_visibility(state, Bvh(casters, 0), s.hemispheres);
}
BENCHMARK(placed_hemispheres)->Arg(170)->Arg(708);

#ifdef ZONEPLATE_EMBREE
const EmbreeScene& embree_of(std::int64_t n) {
  static const EmbreeScene small(scene(170).mesh), large(scene(708).mesh);
  return n == 170 ? small : large;
}

void embree_build(benchmark::State& state) {
  const TestMesh& mesh = scene(state.range(0)).mesh;
  for (auto _ : state) const EmbreeScene built(mesh);
}
BENCHMARK(embree_build)->Arg(170)->Arg(708)->Unit(benchmark::kMillisecond);

void embree_primary(benchmark::State& state) {
  const std::vector<Ray>& rays = scene(state.range(0)).primary;
  const EmbreeScene& embree = embree_of(state.range(0));
  for (auto _ : state)
    for (const Ray& ray : rays) benchmark::DoNotOptimize(embree.nearest(ray));
  per_ray(state, rays.size());
}
BENCHMARK(embree_primary)->Arg(170)->Arg(708);

void time_embree(benchmark::State& state, const std::vector<Ray>& rays) {
  const EmbreeScene& embree = embree_of(state.range(0));
  for (auto _ : state)
    for (const Ray& ray : rays) benchmark::DoNotOptimize(embree.is_visible(ray));
  per_ray(state, rays.size());
}
void embree_shadow(benchmark::State& state) { time_embree(state, scene(state.range(0)).shadow); }
BENCHMARK(embree_shadow)->Arg(170)->Arg(708);
void embree_occlusion(benchmark::State& state) { time_embree(state, scene(state.range(0)).occlusion); }
BENCHMARK(embree_occlusion)->Arg(170)->Arg(708);
void embree_hemispheres(benchmark::State& state) { time_embree(state, scene(state.range(0)).hemispheres); }
BENCHMARK(embree_hemispheres)->Arg(170)->Arg(708);

/// Packets of 16, in both of Embree's traversals: `coherent` and not.
template <class Trace>
void time_packets(benchmark::State& state, const std::vector<Ray>& rays, Trace trace) {
  const EmbreeScene& embree = embree_of(state.range(0));
  const std::vector<RTCRayHit16> packets = embree_packets(rays);
  for (auto _ : state)
    for (RTCRayHit16 packet : packets) {
      trace(embree, packet, state.range(1) != 0);
      benchmark::DoNotOptimize(packet);
    }
  per_ray(state, rays.size());
}
void embree_packets_primary(benchmark::State& state) {
  time_packets(state, scene(state.range(0)).primary,
               [](const EmbreeScene& s, RTCRayHit16& rays, bool is_coherent) { s.intersect(rays, is_coherent); });
}
void time_occluded(benchmark::State& state, const std::vector<Ray>& rays) {
  time_packets(state, rays,
               [](const EmbreeScene& s, RTCRayHit16& packet, bool is_coherent) { s.occlude(packet.ray, is_coherent); });
}
void embree_packets_shadow(benchmark::State& state) { time_occluded(state, scene(state.range(0)).shadow); }
void embree_packets_occlusion(benchmark::State& state) { time_occluded(state, scene(state.range(0)).occlusion); }
void embree_packets_hemispheres(benchmark::State& state) { time_occluded(state, scene(state.range(0)).hemispheres); }
const std::vector<std::string> packet_arguments = {"triangles", "coherent"};
BENCHMARK(embree_packets_primary)->ArgNames(packet_arguments)->ArgsProduct({{170, 708}, {0, 1}});
BENCHMARK(embree_packets_shadow)->ArgNames(packet_arguments)->ArgsProduct({{170, 708}, {0, 1}});
BENCHMARK(embree_packets_occlusion)->ArgNames(packet_arguments)->ArgsProduct({{170, 708}, {0, 1}});
BENCHMARK(embree_packets_hemispheres)->ArgNames(packet_arguments)->ArgsProduct({{170, 708}, {0, 1}});
#endif

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
