// SPDX-License-Identifier: Apache-2.0
// The network of `learned` for frames of 960 × 540, without the pixels around it: time, and multiply-accumulates per
// second beside the machine's limit.
//
// build/bench/network_bench
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/evaluate/bench/limits.h"
#include "zoneplate/math/random.h"
#include "zoneplate/upscale/learned/learned_network.h"

namespace zoneplate {
namespace {

/// 10^9 multiply-accumulates of 16-bit integers per second of all threads, from the first cache.
double limit(int threads) {
  constexpr std::size_t turns = 100'000;
  std::vector<std::int16_t> values(LimitKernels::factors);
  std::iota(values.begin(), values.end(), std::int16_t{0});
  double best = 0;
  for (int attempt = 0; attempt < 20; ++attempt) {
    const Stopwatch watch;
    parallel_for(static_cast<std::size_t>(threads),
                 [&](std::size_t) { benchmark::DoNotOptimize(LimitKernels::of().multiply(values.data(), turns)); });
    best = std::max(best, threads * static_cast<double>(LimitKernels::factors * turns) / watch.ms() * 1e-6);
  }
  return best;
}

void infer(benchmark::State& state) {
  constexpr int width = 960, height = 540;
  const network::Network& trained = upscale::LearnedNetwork::trained();
  constexpr int outputs = upscale::LearnedNetwork::form.outputs;
  const auto threads = static_cast<int>(state.range(0));
  network::NetworkFrame frame(width, height, upscale::LearnedNetwork::features);
  for (std::size_t i = 0; i < frame.features.values.size(); ++i)
    frame.features.values[i] = static_cast<std::int16_t>(hash(static_cast<std::uint32_t>(i)) & 127);
  with_threads(threads, [&] {
    PerThread<std::vector<float>> out;
    double least = std::numeric_limits<double>::infinity();
    for (auto _ : state) {
      const Stopwatch watch;
      trained.read(frame);
      parallel_for(height, [&](std::size_t y) {
        std::vector<float>& row = out.local(static_cast<std::size_t>(width * outputs));
        trained.write(frame, 0, static_cast<int>(y), width, 0, outputs, row.data());
        benchmark::DoNotOptimize(row.data());
      });
      least = std::min(least, watch.ms());
    }
    const double rate = static_cast<double>(trained.multiplications(width, height)) / least * 1e-6;
    const double most = limit(threads);
    state.counters["ms"] = least;
    state.counters["ns_per_output_pixel"] = least * 1e6 / (4.0 * width * height);
    state.counters["GMAC_s"] = rate;
    state.counters["limit_GMAC_s"] = most;
    state.counters["of_limit"] = rate / most;
  });
}
BENCHMARK(infer)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->Iterations(20);

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
