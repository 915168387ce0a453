// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/evaluate/bench/limits.h"
#include "zoneplate/math/random.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate::cli {
namespace {

TEST(Bench, TellsOneLineOfJsonASceneAndNumberOfSamples) {
  const std::vector<std::string> arguments = {"tri10k", "--json", "--size", "160x90", "--frames", "2", "--warmup", "1"};
  testing::internal::CaptureStdout();
  run_bench(arguments);
  std::istringstream lines(testing::internal::GetCapturedStdout());
  std::string line;
  std::vector<int> samples;
  while (std::getline(lines, line)) {
    const auto json = parsed_json(line);
    EXPECT_EQ(json["format"], "zoneplate-bench");
    EXPECT_EQ(json["scene"], "tri10k");
    EXPECT_GT(json["median_ms"].get<double>(), 0);
    EXPECT_GE(json["median_ms"].get<double>(), json["min_ms"].get<double>());
    EXPECT_GT(json["min_ms_by_stage"]["tiles"].get<double>(), 0);
    // The times of the tiles' stages are sums over all threads, within the time of the tiles.
    const auto& stages = json["stages_of_best_ms"];
    EXPECT_GT(stages["vertices"].get<double>(), 0);
    EXPECT_GT(stages["triangles"].get<double>(), 0);
    EXPECT_GT(stages["shading"].get<double>(), 0);
    EXPECT_EQ(stages["blending"].get<double>(), 0);
    EXPECT_GT(stages["encode"].get<double>(), 0);
    samples.push_back(json["samples"].get<int>());
  }
  EXPECT_EQ(samples, (std::vector{1, 4}));
}

TEST(Bench, AnisotropyIsTheScenesUnlessAskedFor) {
  const auto anisotropy = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--samples", "1", "--size", "64x36", "--frames", "1", "--warmup", "1"});
    testing::internal::CaptureStdout();
    run_bench(arguments);
    return parsed_json(testing::internal::GetCapturedStdout())["aniso"].get<int>();
  };
  EXPECT_EQ(anisotropy({"--scene", "city"}), 8);
  EXPECT_EQ(anisotropy({"--scene", "city-trilinear"}), 1);
  EXPECT_EQ(anisotropy({"--scene", "city", "--aniso", "1"}), 1);
  EXPECT_EQ(anisotropy({"--scene", "fill", "--aniso", "4"}), 4);
}

TEST(Bench, ItsInstructionSetIsTheOneAskedFor) {
  for (const Isa isa : supported_isas()) {
    testing::internal::CaptureStdout();
    run_bench(std::vector<std::string>{"--scene", "tri10k", "--size", "64x36", "--frames", "1", "--samples", "1",
                                       "--isa", name_of(isa)});
    EXPECT_EQ(parsed_json(testing::internal::GetCapturedStdout())["renderer"], name_of(isa));
  }
}

TEST(Bench, TellsTheStagesBesideTheMachinesLimits) {
  testing::internal::CaptureStdout();
  run_bench(std::vector<std::string>{"tri10k", "--size", "96x54", "--frames", "1", "--samples", "1"});
  const std::string text = testing::internal::GetCapturedStdout();
  for (const char* part : {"GB/s read", "Gather of", "tri10k 1x: ", "vertices", "ns a vertex", "ns a triangle",
                           "ns a pixel", "ns a fragment", "from memory", "(encode)"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  EXPECT_EQ(text.find("blending"), std::string::npos);
}

TEST(Bench, SimulatesMoreThreads) {
  testing::internal::CaptureStdout();
  run_bench(
      std::vector<std::string>{"tri10k", "--simulate-threads", "--size", "128x64", "--frames", "1", "--samples", "1"});
  const std::string text = testing::internal::GetCapturedStdout();
  for (const char* part : {"on one thread", "loop over 2 items", "outside of loops", "64 x"})  // two tiles
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  EXPECT_THROW(run_bench(std::vector<std::string>{"tri10k", "--simulate-threads", "--json"}), Error);
}

TEST(LimitKernels, AllInstructionSetsSumTheSame) {
  std::vector<std::uint32_t> words(320);
  std::vector<std::int32_t> index(320);
  std::uint32_t sum = 0, gathered = 0;
  for (std::uint32_t i = 0; i < 320; ++i) {
    words[i] = hash(i);
    index[i] = static_cast<std::int32_t>(hash(i, 1) % 320);
  }
  for (std::size_t i = 0; i < 320; ++i) sum += words[i], gathered += words[static_cast<std::size_t>(index[i])];
  std::vector<std::int16_t> values(LimitKernels::factors);
  std::uint32_t product = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<std::int16_t>(hash(static_cast<std::uint32_t>(i), 2));
    product += static_cast<std::uint32_t>(3 * values[i]);
  }
  for (const Isa isa : supported_isas()) {
    EXPECT_EQ(LimitKernels::of(isa).sum(words.data(), 320), sum);
    EXPECT_EQ(LimitKernels::of(isa).gather(words.data(), index.data(), 320), gathered);
    EXPECT_EQ(LimitKernels::of(isa).multiply(values.data(), 1000), 1000 * product);
  }
}

TEST(Bench, RefusesWhatIsNoScene) {
  const std::vector<std::string> arguments = {"no-such-scene", "--samples", "1"};
  EXPECT_THROW(run_bench(arguments), Error);
}

}  // namespace
}  // namespace zoneplate::cli
