#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/verbs.h"

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
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json["scene"], "tri10k");
    EXPECT_GT(json["median_ms"].get<double>(), 0);
    EXPECT_GE(json["median_ms"].get<double>(), json["min_ms"].get<double>());
    EXPECT_GT(json["min_ms_by_stage"]["tiles"].get<double>(), 0);
    samples.push_back(json["samples"].get<int>());
  }
  EXPECT_EQ(samples, (std::vector{1, 4}));
}

TEST(Bench, RefusesWhatIsNoScene) {
  const std::vector<std::string> arguments = {"no-such-scene", "--samples", "1"};
  EXPECT_THROW(run_bench(arguments), Error);
}

}  // namespace
}  // namespace zoneplate::cli
