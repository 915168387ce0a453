// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/bench/limits.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/geometry/arena.h"

namespace zoneplate {
namespace {

constexpr std::size_t frame_bytes = std::size_t{1920} * 1080 * 8;

double min_ms(int turns, const std::function<void()>& work) {
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < turns; ++i) {
    const Stopwatch watch;
    work();
    least = std::min(least, watch.ms());
  }
  return least;
}

/// The time per gather of eight words at random positions of a table, in nanoseconds.
double gather_ns(std::size_t table_bytes, const std::uint32_t* table) {
  constexpr std::size_t indices = std::size_t{1} << 16;
  std::vector<std::int32_t> index(indices);
  for (std::uint32_t i = 0; i < indices; ++i)
    index[i] = static_cast<std::int32_t>(hash(i) % static_cast<std::uint32_t>(table_bytes / 4));
  const LimitKernels& kernels = LimitKernels::of();
  volatile std::uint32_t result = 0;
  return min_ms(15, [&] { result = kernels.gather(table, index.data(), indices); }) * 1e6 / (indices / 8);
}

}  // namespace

MachineLimits measure_limits() {
  MachineLimits out;
  // Four times the size of the largest cache of most machines.
  constexpr std::size_t size = std::size_t{1} << 27;
  RawMemory memory;
  std::byte* bytes = memory.reserve(size);
  const auto threads = static_cast<std::size_t>(thread_limit());
  const std::size_t share = size / threads / 4096 * 4096;
  const auto on_all = [&](std::size_t each, const std::function<void(std::byte*)>& work) {
    return [&, each, work] { parallel_for(threads, [&](std::size_t t) { work(bytes + t * each); }); };
  };
  const double gigabytes = static_cast<double>(share * threads) * 1e-9;
  out.write_gb_s = gigabytes / min_ms(5, on_all(share, [&](std::byte* p) { std::memset(p, 1, share); })) * 1e3;
  std::atomic<std::uint32_t> result = 0;  // sum over all threads, so that no load is optimized away
  const LimitKernels& kernels = LimitKernels::of();
  out.read_gb_s = gigabytes * 1e3 / min_ms(5, on_all(share, [&](std::byte* p) {
                                             result = kernels.sum(reinterpret_cast<const std::uint32_t*>(p), share / 4);
                                           }));
  const std::size_t part = frame_bytes / threads / 128 * 128;
  out.clear_ms = min_ms(31, on_all(part, [&](std::byte* p) { std::memset(p, 0, part); }));
  out.first_touch_ms = min_ms(3, [&] {
    // Newly allocated memory each time, with pages of default size.
    const std::vector<char> fresh(frame_bytes, 1);
    result = static_cast<std::uint32_t>(fresh.back());
  });
  const auto* words = reinterpret_cast<const std::uint32_t*>(bytes);
  out.gather_l1_ns = gather_ns(std::size_t{1} << 13, words);
  out.gather_l2_ns = gather_ns(std::size_t{1} << 18, words);
  out.gather_l3_ns = gather_ns(std::size_t{1} << 22, words);
  return out;
}

}  // namespace zoneplate
