// SPDX-License-Identifier: Apache-2.0
// Speed of rasterizing: the geometry stage (vertices, culling, setup, sorting into tiles) in nanoseconds a triangle,
// and frames without their shading.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/draw_list.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
namespace {

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A frame of 1920 × 1080 of a built-in scene.
struct Setting {
  Scene scene;
  RenderOptions options;
  SceneDraws draws;
  Target target;
  LinearImage color;
  Setting(const char* name, int samples) : scene(*make_builtin_scene(name)), color(1920, 1080) {
    options.width = color.width(), options.height = color.height();
    const Camera& camera = scene.cameras[0];
    draws = make_draws(scene, camera.clip_from_camera(16.0f / 9) * inverse(camera.world_from_camera), options);
    target.viewport = {options.width, options.height};
    target.width = options.width, target.height = options.height;
    target.samples = standard_pattern(samples);
    target.color = &color;
  }
};

// Processor time of all threads, the least of all turns, because on a busy machine the clock on the wall counts its
// other work too.
void geometry(benchmark::State& state, const char* name) {
  const Setting s(name, static_cast<int>(state.range(0)));
  double vertices_ms = 1e9, triangles_ms = 1e9;
  with_threads(static_cast<int>(state.range(1)), [&] {
    ProjectedDraws projected;
    Bins bins;
    for (auto _ : state) {
      const double start = processor_ms();
      projected = project_draws(s.draws.draws, s.target.viewport, std::move(projected));
      const double transformed = processor_ms();
      bins = bin_triangles(projected, s.target, RasterRules{}, std::move(bins));
      const double binned = processor_ms();
      vertices_ms = std::min(vertices_ms, transformed - start);
      triangles_ms = std::min(triangles_ms, binned - transformed);
    }
    state.counters["ns_per_triangle"] =
        1e6 * (vertices_ms + triangles_ms) / static_cast<double>(projected.first_triangle.back());
  });
  state.counters["vertices_ms"] = vertices_ms;
  state.counters["triangles_ms"] = triangles_ms;
}

class White : public FragmentShader {
 public:
  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.padded(); ++i) out.r[i] = out.g[i] = out.b[i] = out.a[i] = 1;
  }
  float alpha(const FragmentBatch&, float*) const override { return 0; }
};

// All of a frame but its shading.
void frame(benchmark::State& state, const char* name) {
  const Setting s(name, static_cast<int>(state.range(0)));
  double frame_ms = 1e9;
  with_threads(static_cast<int>(state.range(1)), [&] {
    RasterMemory memory;
    for (auto _ : state) {
      const double start = processor_ms();
      rasterize(s.draws.draws, White(), {}, s.target, &memory);
      frame_ms = std::min(frame_ms, processor_ms() - start);
    }
  });
  state.counters["frame_ms"] = frame_ms;
}

void frames(benchmark::internal::Benchmark* b) {
  b->ArgNames({"samples", "threads"})->ArgsProduct({{1, 4, 8}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK_CAPTURE(geometry, tri1m, "tri1m")->Apply(frames);
BENCHMARK_CAPTURE(geometry, micro, "micro")->Apply(frames);
BENCHMARK_CAPTURE(geometry, sphere_100k, "sphere:triangles=100000")->Apply(frames);
BENCHMARK_CAPTURE(geometry, sphere_30k, "sphere:triangles=30000")->Apply(frames);
BENCHMARK_CAPTURE(geometry, city, "city")->Apply(frames);
BENCHMARK_CAPTURE(frame, tri1m, "tri1m")->Apply(frames);
BENCHMARK_CAPTURE(frame, micro, "micro")->Apply(frames);
BENCHMARK_CAPTURE(frame, sphere_100k, "sphere:triangles=100000")->Apply(frames);
BENCHMARK_CAPTURE(frame, sphere_30k, "sphere:triangles=30000")->Apply(frames);
BENCHMARK_CAPTURE(frame, city, "city")->Apply(frames);

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
