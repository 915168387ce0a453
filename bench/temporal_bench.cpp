// SPDX-License-Identifier: Apache-2.0
// Speed of methods with history and of upscalers: the time of their own passes, without rendering, per pixel of the
// image, against a copy of an 8-bit image in the same run. The camera moves, so that history is filtered.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

/// An image of this size by some threads.
struct Conditions {
  int width, height, threads;
};
constexpr Conditions usual{1280, 720, 1};

/// The least time of several copies of an 8-bit image that exceeds the caches, in ns per pixel.
double copy_ns() {
  Rgba8Image from(8 * usual.width, 8 * usual.height), to = from;
  double least = 1e9;
  for (int i = 0; i < 20; ++i) {
    const Stopwatch watch;
    std::memcpy(to.values().data(), from.values().data(), from.values().size_bytes());
    benchmark::DoNotOptimize(to.values().data());
    benchmark::ClobberMemory();
    least = std::min(least, watch.ms());
  }
  return least * 1e6 / static_cast<double>(from.values().size());
}

void measure(benchmark::State& state, const std::string& scene_name, const std::string& method,
             const Conditions& conditions) {
  const int width = conditions.width, height = conditions.height;
  Scene scene = *make_builtin_scene(scene_name);
  const Camera camera = choose_camera(scene, {.index = 0}, static_cast<float>(width) / static_cast<float>(height));
  Lighting lighting = make_lighting(scene, {});
  scene.lights = std::move(lighting.lights);
  scene.environment = lighting.environment;
  with_threads(conditions.threads, [&] {
    Renderer renderer(PreparedScene(std::move(scene)), upscale::make_method(method));
    const RenderSettings settings{.options = {.width = width, .height = height}};
    double least = 1e9;
    int frame = 0;
    for (auto _ : state) {
      Camera moved = camera;
      const float time = static_cast<float>(frame++);
      moved.world_from_camera =
          camera.world_from_camera * (scene_name == "city" ? translation(float3{0.003f * time, 0, 0})
                                                           : rotation(float3{0, 1, 0}, 0.017f / 24 * time));
      const RenderCounts counts = renderer.render(moved, settings).counts;
      if (frame > 1) least = std::min(least, counts.resolve_ms + counts.filter_ms);
    }
    const double copy = copy_ns();
    const double ns = least * 1e6 / (static_cast<double>(width) * height);
    state.counters["ms"] = least;
    state.counters["ns_per_pixel"] = ns;
    state.counters["copy_ns"] = copy;
    state.counters["over_copy"] = ns / copy;
  });
}

}  // namespace
}  // namespace zoneplate

int main(int argc, char** argv) {
  const auto add = [](const std::string& name, const std::string& scene, const std::string& method,
                      const zoneplate::Conditions& conditions) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& s) { zoneplate::measure(s, scene, method, conditions); })
        ->Iterations(12)
        ->Unit(benchmark::kMillisecond);
  };
  for (const std::string method : {"taa",
                                   "taa:preset=karis",
                                   "taa:preset=inside",
                                   "taa:preset=salvi",
                                   "taa:preset=three",
                                   "taa:preset=playcanvas",
                                   "taa:preset=bevy",
                                   "history-guided",
                                   "oracle-taa",
                                   "smaa:mode=t2x",
                                   "bilinear:scale=2",
                                   "lanczos:scale=2",
                                   "sgsr1:scale=2",
                                   "nis:scale=2",
                                   "fsr1:scale=2",
                                   "fsr2:scale=2",
                                   "fsr3:scale=2",
                                   "sgsr2:scale=2",
                                   "taau:scale=2",
                                   "learned:scale=2",
                                   "learned:scale=1",
                                   "learned-table:scale=2",
                                   "learned-still:scale=2",
                                   "learned-table-still:scale=2",
                                   "taau:scale=2,preset=karis"})
    for (const std::string scene : {"city", "panning-wires"})
      add(scene + "/" + method, scene, method, zoneplate::usual);
  for (const std::string method :
       {"fsr2:scale=2", "fsr3:scale=2", "sgsr2:scale=2", "taau:scale=2", "learned-table:scale=2", "learned:scale=2"})
    for (const int threads : {1, 2})
      add("1080p/" + method + "/threads:" + std::to_string(threads), "city", method, {1920, 1080, threads});
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
