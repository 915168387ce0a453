// SPDX-License-Identifier: Apache-2.0
// Speed of the signal folder against a copy of the same plane: the ratio is the figure that does not depend on the day.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/signal/filter/convolve.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/noise_for_test.h"

namespace zoneplate {
namespace {

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Copies by bands on the same threads as the filters.
void copy(const Plane<float>& from, Plane<float>& to) {
  parallel_ranges(static_cast<std::size_t>(from.height()), 32, [&](std::size_t begin, std::size_t end) {
    const auto width = static_cast<std::size_t>(from.width());
    std::memcpy(to.row(static_cast<int>(begin)).data(), from.row(static_cast<int>(begin)).data(),
                (end - begin) * width * sizeof(float));
  });
}

// 1080p, Gaussian of sigma 8, both directions. Sixteen planes of 8 MB take turns, so that none is still in the last
// cache when its turn comes. `pass_over_copy` is the time of one of the two passes over that of one copy: processor
// time of all threads, the least of all turns, because on a busy machine the clock on the wall counts its other work
// too. A turn is long, because the system adds up the time of other threads only a few milliseconds later.
void gaussian_blur(benchmark::State& state) {
  constexpr std::size_t planes = 16, copies = 64, blurs = 6;
  std::vector<Plane<float>> from(planes, noise_plane(1920, 1080)), to = from;
  const auto taps = sampled(make_kernel("gaussian:sigma=8"));
  double copy_ms = 1e9, blur_ms = 1e9;
  std::size_t turn = 0;
  with_threads(static_cast<int>(state.range(0)), [&] {
    for (auto _ : state) {
      const double start = processor_ms();
      for (std::size_t i = 0; i < copies; ++i, ++turn) copy(from[turn % planes], to[(turn + planes / 2) % planes]);
      const double copied = processor_ms();
      for (std::size_t i = 0; i < blurs; ++i, ++turn) {
        Plane<float>& room = to[turn % planes];
        room = convolve_separable(from[(turn + planes / 2) % planes], taps, taps, {}, std::move(room));
      }
      const double blurred = processor_ms();
      copy_ms = std::min(copy_ms, (copied - start) / copies), blur_ms = std::min(blur_ms, (blurred - copied) / blurs);
      benchmark::ClobberMemory();
    }
  });
  state.counters["copy_ms"] = copy_ms;
  state.counters["blur_ms"] = blur_ms;
  state.counters["pass_over_copy"] = blur_ms / 2 / copy_ms;
}
BENCHMARK(gaussian_blur)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void spectrum_of_4096(benchmark::State& state) {
  const Plane<float> plane = noise_plane(4096, 4096);
  with_threads(static_cast<int>(state.range(0)), [&] {
    for (auto _ : state) benchmark::DoNotOptimize(fourier(plane));
  });
}
BENCHMARK(spectrum_of_4096)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
