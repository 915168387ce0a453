// SPDX-License-Identifier: Apache-2.0
// Speed of the methods on shown images, against a copy of the same image on the same threads.
//
// Figures are of processor time, shared out to the threads: on a busy machine the clock on the wall counts its other
// work too. `copy_ns` and `ns_a_pixel` are the least of all turns and `over_copy` their ratio; `median_over_copy` is
// the median of the ratios of single turns. Four images of 33 MB take turns on either side, so that none is still in
// the last cache when its turn comes; results are written into images that are there already, by both.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "scene_codes.h"
#include "zoneplate/antialias/post/cmaa2/cmaa2.h"
#include "zoneplate/antialias/post/ddaa/ddaa.h"
#include "zoneplate/antialias/post/dlaa/dlaa.h"
#include "zoneplate/antialias/post/fxaa/fxaa.h"
#include "zoneplate/antialias/post/learned_smaa/learned_smaa.h"
#include "zoneplate/antialias/post/mlaa/mlaa.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

constexpr int width = 3840, height = 2160;

const Rgba8Image& cached_frame(const std::string& name) {
  static std::map<std::string, Rgba8Image> frames;
  const auto found = frames.find(name);
  return found != frames.end() ? found->second : frames.emplace(name, scene_codes(name, width, height)).first->second;
}

/// The processor time of the whole process. What a thread on another processor has used is counted when it stops, and
/// helpers wait actively for a while before they do: without the pause a copy's time was in part the filter's.
double processor_ms() {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void copy(const Rgba8Image& from, Rgba8Image& to) {
  parallel_ranges(static_cast<std::size_t>(height), 32, [&](std::size_t begin, std::size_t end) {
    std::memcpy(to.row(static_cast<int>(begin)).data(), from.row(static_cast<int>(begin)).data(),
                (end - begin) * width * sizeof(Rgba8));
  });
}

using Filter = std::function<Rgba8Image(const Rgba8Image&, Rgba8Image memory)>;

void measure(benchmark::State& state, const char* scene, const Filter& filter) {
  constexpr std::size_t pictures = 4;
  std::vector<Rgba8Image> from(pictures, cached_frame(scene)), to = from;
  const int threads = static_cast<int>(state.range(0));
  double copy_ms = 1e9, filter_ms = 1e9;
  std::vector<double> ratios;
  std::size_t turn = 0;
  with_threads(threads, [&] {
    for (auto _ : state) {
      const std::size_t a = turn % pictures, b = (turn + pictures / 2) % pictures;
      ++turn;
      const double start = processor_ms();
      copy(from[a], to[b]);
      const double copied = processor_ms();
      to[a] = filter(from[b], std::move(to[a]));
      const double filtered = processor_ms();
      copy_ms = std::min(copy_ms, copied - start), filter_ms = std::min(filter_ms, filtered - copied);
      ratios.push_back((filtered - copied) / (copied - start));
      benchmark::ClobberMemory();
    }
  });
  int changed = 0;
  const Rgba8Image last = filter(from[0], {});
  for (std::size_t i = 0; i < last.values().size(); ++i) changed += last.values()[i] != from[0].values()[i];
  state.counters["copy_ns"] = copy_ms * 1e6 / (width * height) / threads;
  state.counters["ns_a_pixel"] = filter_ms * 1e6 / (width * height) / threads;
  state.counters["over_copy"] = filter_ms / copy_ms;
  std::ranges::nth_element(ratios, ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2));
  state.counters["median_over_copy"] = ratios[ratios.size() / 2];
  state.counters["changed_percent"] = 100.0 * changed / (width * height);
}

struct Row {
  const char* name;
  Filter filter;
};

void register_all() {
  using namespace antialias;
  const Row rows[] = {
      {"fxaa_12", [](const Rgba8Image& i, Rgba8Image m) { return apply_fxaa(i, {}, std::move(m)); }},
      {"fxaa_39", [](const Rgba8Image& i, Rgba8Image m) { return apply_fxaa(i, {.preset = 39}, std::move(m)); }},
      {"fxaa_console",
       [](const Rgba8Image& i, Rgba8Image m) {
         return apply_fxaa(i, {.preset = FxaaOptions::console, .threshold = 0.125, .least = 0.05}, std::move(m));
       }},
      {"smaa_high", [](const Rgba8Image& i, Rgba8Image m) { return apply_smaa(i, nullptr, {}, std::move(m)); }},
      {"smaa_high_color",
       [](const Rgba8Image& i, Rgba8Image m) {
         return apply_smaa(i, nullptr, {.edges = SmaaOptions::Edges::Color}, std::move(m));
       }},
      {"learned_smaa", [](const Rgba8Image& i, Rgba8Image) { return apply_learned_smaa(i); }},
      {"mlaa", [](const Rgba8Image& i, Rgba8Image m) { return apply_mlaa(i, {}, std::move(m)); }},
      {"mlaa_reshetov",
       [](const Rgba8Image& i, Rgba8Image m) {
         return apply_mlaa(i, {.kind = MlaaOptions::Kind::Reshetov}, std::move(m));
       }},
      {"cmaa2", [](const Rgba8Image& i, Rgba8Image m) { return apply_cmaa2(i, {}, std::move(m)); }},
      {"dlaa", [](const Rgba8Image& i, Rgba8Image m) { return apply_dlaa(i, std::move(m)); }},
      {"ddaa", [](const Rgba8Image& i, Rgba8Image m) { return apply_ddaa(i, {}, std::move(m)); }},
  };
  for (const Row& row : rows)
    for (const char* scene : {"teapot", "city"})
      benchmark::RegisterBenchmark((std::string(row.name) + "/" + scene).c_str(),
                                   [scene, filter = row.filter](benchmark::State& s) { measure(s, scene, filter); })
          ->ArgName("threads")
          ->Arg(1)
          ->Arg(2)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
}

}  // namespace
}  // namespace zoneplate

int main(int argc, char** argv) {
  zoneplate::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
