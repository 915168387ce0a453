// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/batch/shard.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate::cli {
namespace {

using Variables = std::map<std::string, std::string>;

/// "index/count", or the error.
std::string shard(const std::string& text, const Variables& variables = {}) {
  std::map<std::string, std::string> before;
  for (const char* name :
       {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX", "CLOUD_RUN_TASK_INDEX",
        "BATCH_TASK_INDEX", "PBS_ARRAY_INDEX", "PBS_ARRAYID", "SGE_TASK_ID", "LSB_JOBINDEX"}) {
    if (const char* value = std::getenv(name)) before[name] = value;
    ::unsetenv(name);
  }
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  std::string out;
  try {
    const Shard shard = parse_shard(text);
    out = std::to_string(shard.index) + '/' + std::to_string(shard.count);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    out = error.what();
  }
  for (const auto& [name, value] : variables) ::unsetenv(name.c_str());
  for (const auto& [name, value] : before) ::setenv(name.c_str(), value.c_str(), 1);
  return out;
}

TEST(Shard, IsANumberOfSeveral) {
  EXPECT_EQ(shard("0/1"), "0/1");
  EXPECT_EQ(shard("3/8"), "3/8");
  for (const char* text :
       {"", "1", "8/8", "-1/8", "1/", "/8", "1/0", "0/0", "auto/", "auto/0", "auto/x", "auto/8/9", "1/8x"})
    EXPECT_NE(shard(text).find("is not a shard i/n"), std::string::npos) << text << ' ' << shard(text);
}

/// What Slurm sets for a task of an array.
Variables slurm(int task, const std::vector<int>& array, int step) {
  return {{"SLURM_ARRAY_TASK_ID", std::to_string(task)},
          {"SLURM_ARRAY_TASK_MIN", std::to_string(array.front())},
          {"SLURM_ARRAY_TASK_MAX", std::to_string(array.back())},
          {"SLURM_ARRAY_TASK_STEP", std::to_string(step)},
          {"SLURM_ARRAY_TASK_COUNT", std::to_string(array.size())}};
}

// 0-9:3 and the rest, 3,7 after a failure, 5-6 again: each task has the same items in every array.
TEST(Shard, AnArrayOfTasksIsCountedFromItsBeginning) {
  std::multiset<std::string> made;
  for (const auto& [array, step] :
       std::vector<std::pair<std::vector<int>, int>>{{{0, 3, 6, 9}, 3}, {{1, 4, 7}, 3}, {{2}, 1}, {{5, 8}, 3}})
    for (const int task : array) made.insert(shard("auto/10", slurm(task, array, step)));
  EXPECT_EQ(made, (std::multiset<std::string>{"0/10", "1/10", "2/10", "3/10", "4/10", "5/10", "6/10", "7/10", "8/10",
                                              "9/10"}));
  EXPECT_EQ(shard("auto/100", slurm(6, {5, 6}, 1)), "6/100");
  EXPECT_EQ(shard("auto/10", slurm(10, {1, 10}, 1)),
            "'auto/10': SLURM_ARRAY_TASK_ID is 10, and the tasks of 10 shards are 0 to 9");
}

TEST(Shard, TheSizeOfAnArrayIsNotItsNumberOfShards) {
  for (const auto& variables :
       {slurm(1, {0, 1}, 1), Variables{{"JOB_COMPLETION_INDEX", "1"}}, Variables{{"PBS_ARRAY_INDEX", "1"}},
        Variables{{"SGE_TASK_ID", "1"}, {"SGE_TASK_LAST", "2"}}, Variables{{"AWS_BATCH_JOB_ARRAY_INDEX", "1"}}})
    EXPECT_NE(shard("auto", variables).find("give it, for example auto/10"), std::string::npos)
        << shard("auto", variables);
}

TEST(Shard, EnginesStateTheirNumbers) {
  const std::pair<Variables, std::string> rows[] = {
      {{{"AWS_BATCH_JOB_ARRAY_INDEX", "3"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "8"}}, "3/8"},
      {{{"CLOUD_RUN_TASK_INDEX", "0"}, {"CLOUD_RUN_TASK_COUNT", "8"}}, "0/8"},
      {{{"BATCH_TASK_INDEX", "7"}, {"BATCH_TASK_COUNT", "8"}}, "7/8"},
      {{{"BATCH_TASK_INDEX", "8"}, {"BATCH_TASK_COUNT", "8"}},
       "'auto': BATCH_TASK_INDEX is 8, and the tasks of 8 shards are 0 to 7"},
      {{{"BATCH_TASK_INDEX", "0"}, {"BATCH_TASK_COUNT", "many"}},
       "BATCH_TASK_COUNT is 'many', expected a whole number"}};
  for (const auto& [variables, expected] : rows) EXPECT_EQ(shard("auto", variables), expected);
  const std::pair<Variables, std::string> given[] = {
      {{{"AWS_BATCH_JOB_ARRAY_INDEX", "3"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "4"}}, "3/8"},
      {{{"JOB_COMPLETION_INDEX", "7"}}, "7/8"},
      {{{"PBS_ARRAY_INDEX", "2"}}, "2/8"},
      {{{"PBS_ARRAYID", "2"}}, "2/8"},
      {{{"SGE_TASK_ID", "1"}}, "0/8"},
      {{{"SGE_TASK_ID", "8"}, {"LSB_JOBINDEX", "0"}}, "7/8"},
      {{{"LSB_JOBINDEX", "8"}, {"SGE_TASK_ID", "undefined"}}, "7/8"},
      {{{"SGE_TASK_ID", "9"}}, "'auto/8': SGE_TASK_ID is 9, and the tasks of 8 shards are 1 to 8"},
      {{{"SLURM_ARRAY_TASK_ID", "-1"}}, "SLURM_ARRAY_TASK_ID is '-1', expected a whole number"},
      {{{"SLURM_ARRAY_TASK_ID", "1"}, {"JOB_COMPLETION_INDEX", "2"}},
       "SLURM_ARRAY_TASK_ID and JOB_COMPLETION_INDEX are both set: give the shard as i/n"}};
  for (const auto& [variables, expected] : given) EXPECT_EQ(shard("auto/8", variables), expected);
  EXPECT_NE(shard("auto/8").find("give i/n, for example 0/10"), std::string::npos);
}

}  // namespace
}  // namespace zoneplate::cli
