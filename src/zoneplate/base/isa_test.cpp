// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/isa.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string>

#include "zoneplate/base/parallel.h"
#include "zoneplate/base/paths_for_test.h"

namespace zoneplate {

/// Kernels that only identify the instruction set of their table.
struct NamedKernels : PerIsa<NamedKernels> {
  Isa isa;
};

template <>
const NamedKernels PerIsa<NamedKernels>::scalar = {.isa = Isa::Scalar};
template <>
const NamedKernels PerIsa<NamedKernels>::N_SSE4 = {.isa = Isa::Sse4};
template <>
const NamedKernels PerIsa<NamedKernels>::N_AVX2 = {.isa = Isa::Avx2};
template <>
const NamedKernels PerIsa<NamedKernels>::N_AVX3 = {.isa = Isa::Avx512};
template <>
const NamedKernels PerIsa<NamedKernels>::N_NEON = {.isa = Isa::Neon};
template <>
const NamedKernels PerIsa<NamedKernels>::N_WASM = {.isa = Isa::Wasm};

namespace {

TEST(Isa, EveryItemOfALoopTakesTheTableOfTheEnclosingWithIsa) {
  EXPECT_EQ(NamedKernels::of().isa, best_isa());
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 7})
      with_threads(threads, [&] {
        std::array<Isa, 100> taken{};
        with_isa(isa, [&] { parallel_for(taken.size(), [&](std::size_t i) { taken[i] = NamedKernels::of().isa; }); });
        for (const Isa each : taken) EXPECT_EQ(each, isa) << threads;
        // The threads of the team keep their previous instruction set.
        parallel_for(taken.size(), [&](std::size_t i) { taken[i] = NamedKernels::of().isa; });
        for (const Isa each : taken) EXPECT_EQ(each, best_isa()) << threads;
      });
}

TEST(Isa, TheInnermostWithIsaHoldsAndItsEndBringsTheOuterOneBack) {
  with_isa(Isa::Scalar, [] {
    EXPECT_EQ(with_isa(best_isa(), [] { return NamedKernels::of().isa; }), best_isa());
    EXPECT_EQ(current_isa(), Isa::Scalar);
    EXPECT_THROW(with_isa(best_isa(), [] { throw std::runtime_error("stop"); }), std::runtime_error);
    EXPECT_EQ(current_isa(), Isa::Scalar);
  });
  EXPECT_EQ(current_isa(), best_isa());
}

/// Guarantees that `--isa` affects every kernel of a run: the library obtains every table by `of()`, and none of its
/// options, parameters or objects contains an instruction set. Only the command, which parses `--isa`, names the type.
TEST(Isa, NoSourceOfTheLibraryTakesATableForAnIsaOfItsOwn) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(source_root) / "src/zoneplate";
  const std::regex own_choice(R"(best_isa\(\)|Kernels::of\([^)]|PerIsa<\w+>::(?!scalar|HWY_NAMESPACE)\w)"),
      type(R"(\bIsa\b)");
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string path = entry.path().lexically_relative(root).string();
    if (!entry.is_regular_file() || path.starts_with("base/isa") || path == "cli/version.cpp" ||
        path.find("_test.") != std::string::npos)
      continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto has = [&](const char* part) { return text.find(part) != std::string::npos; };
    if (!has("Isa") && !has("best_isa") && !has("Kernels::of(")) continue;  // regular expressions are slow
    EXPECT_FALSE(std::regex_search(text, own_choice)) << path;
    const bool is_door = path.starts_with("cli/") || path.starts_with("job/") || path.starts_with("capi/");
    EXPECT_TRUE(is_door || path == "base/parallel.cpp" || !std::regex_search(text, type)) << path;
  }
}

}  // namespace
}  // namespace zoneplate
