// SPDX-License-Identifier: Apache-2.0
// The numbers of text formats (OBJ, MTL, ASCII PLY and STL): our reader beside the standard library's. libstdc++ 12
// converts by Lemire's fast_float; both round to the nearest float.
#include <benchmark/benchmark.h>

#include <charconv>
#include <cstdio>
#include <string>
#include <vector>

#include "zoneplate/formats/import/text_scan.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

// Numbers between spaces, as exporters write coordinates: six decimals, shortest, or with an exponent.
std::string numbers(const char* format) {
  std::string text;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    char word[64];
    const int size = std::snprintf(word, sizeof word, format, static_cast<double>(unit_float(hash(i)) * 200 - 100));
    text.append(word, static_cast<std::size_t>(size)) += ' ';
  }
  return text;
}

constexpr const char* formats[] = {"%.6f", "%.9g", "%.6e"};

void ours(benchmark::State& state) {
  const std::string text = numbers(formats[state.range(0)]);
  for (auto _ : state) {
    const char *at = text.data(), *const end = at + text.size();
    float sum = 0, value = 0;
    while (at != end && (at = scan_number(at, end, value)) != nullptr) sum += value, ++at;
    benchmark::DoNotOptimize(sum);
    if (at != end) state.SkipWithError("a number was left to find_number");
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(ours)->DenseRange(0, 2);

void standard_library(benchmark::State& state) {
  const std::string text = numbers(formats[state.range(0)]);
  for (auto _ : state) {
    const char *at = text.data(), *const end = at + text.size();
    float sum = 0, value = 0;
    while (at != end) at = std::from_chars(at, end, value).ptr + 1, sum += value;
    benchmark::DoNotOptimize(sum);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(standard_library)->DenseRange(0, 2);

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
