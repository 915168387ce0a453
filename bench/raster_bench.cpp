// Speed of the geometry stage: vertices, culling, setup and sorting into tiles, in nanoseconds a triangle.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/bin.h"
#include "zoneplate/render/surfaces.h"
#include "zoneplate/scene/builtin.h"

namespace zoneplate {
namespace {

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// A frame of 1920 × 1080. Processor time of all threads, the least of all turns, because on a busy machine the clock on
// the wall counts its other work too.
void geometry(benchmark::State& state, const char* name) {
  const Scene scene = *make_builtin_scene(name);
  const Camera& camera = scene.cameras[0];
  RenderOptions options;
  options.width = 1920, options.height = 1080;
  const float4x4 clip_from_world = camera.clip_from_camera(1920.0f / 1080.0f) * inverse(camera.world_from_camera);
  Target target;
  target.viewport = {options.width, options.height};
  target.width = options.width, target.height = options.height;
  target.samples = standard_pattern(static_cast<int>(state.range(0)));
  double vertices_ms = 1e9, triangles_ms = 1e9;
  std::size_t triangles = 0;
  with_threads(static_cast<int>(state.range(1)), [&] {
    const SceneDraws draws = make_draws(scene, clip_from_world, options);
    ProjectedDraws projected;
    Bins bins;
    for (auto _ : state) {
      const double start = processor_ms();
      projected = project_draws(draws.draws, target.viewport, options.isa, std::move(projected));
      const double transformed = processor_ms();
      bins = bin_triangles(projected, target, {.viewport = target.viewport}, options.isa, std::move(bins));
      const double binned = processor_ms();
      benchmark::DoNotOptimize(bins.set_up);
      vertices_ms = std::min(vertices_ms, transformed - start);
      triangles_ms = std::min(triangles_ms, binned - transformed);
      triangles = static_cast<std::size_t>(projected.first_triangle.back());
    }
  });
  state.counters["vertices_ms"] = vertices_ms;
  state.counters["triangles_ms"] = triangles_ms;
  state.counters["ns_per_triangle"] = 1e6 * (vertices_ms + triangles_ms) / static_cast<double>(triangles);
}

void frames(benchmark::internal::Benchmark* b) {
  b->ArgNames({"samples", "threads"})->ArgsProduct({{1, 4}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK_CAPTURE(geometry, tri1m, "tri1m")->Apply(frames);
BENCHMARK_CAPTURE(geometry, micro, "micro")->Apply(frames);
BENCHMARK_CAPTURE(geometry, sphere_100k, "sphere:triangles=100000")->Apply(frames);
BENCHMARK_CAPTURE(geometry, city, "city")->Apply(frames);

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
