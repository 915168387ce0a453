// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/shard.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

using Variables = std::map<std::string, std::string>;

/// "index/count", or the error.
std::string shard(const std::string& text, const Variables& variables = {}, std::optional<std::uint64_t> pinned = {}) {
  std::map<std::string, std::string> before;
  for (const char* name :
       {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX", "CLOUD_RUN_TASK_INDEX",
        "BATCH_TASK_INDEX", "PBS_ARRAY_INDEX", "PBS_ARRAYID", "SGE_TASK_ID", "SGE_TASK_STEPSIZE", "LSB_JOBINDEX"}) {
    if (const char* value = std::getenv(name)) before[name] = value;
    ::unsetenv(name);
  }
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  std::string out;
  try {
    const Shard shard = parse_shard(text, pinned);
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
      {{{"AWS_BATCH_JOB_ARRAY_INDEX", "3"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "4"}},
       "'auto/8': AWS_BATCH_JOB_ARRAY_SIZE is 4, and the number of shards 8: give the array as many tasks"},
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

/// The tasks first, first + step, ... up to last.
std::vector<int> tasks(int first, int last, int step = 1) {
  std::vector<int> out;
  for (int task = first; task <= last; task += step) out.push_back(task);
  return out;
}

/// What an engine sets for one task of an array.
using Engine = Variables (*)(int task, const std::vector<int>& array);

Variables set_by_slurm(int task, const std::vector<int>& array) {
  return slurm(task, array, array.size() > 1 ? array[1] - array[0] : 1);
}
Variables set_by_restarted_slurm(int task, const std::vector<int>& array) {
  Variables out = set_by_slurm(task, array);
  out["SLURM_RESTART_COUNT"] = "2";
  return out;
}
Variables set_by_kubernetes(int task, const std::vector<int>&) {
  return {{"JOB_COMPLETION_INDEX", std::to_string(task)}};
}
Variables set_by_aws(int task, const std::vector<int>& array) {
  return {{"AWS_BATCH_JOB_ARRAY_INDEX", std::to_string(task)},
          {"AWS_BATCH_JOB_ARRAY_SIZE", std::to_string(array.size())},
          {"AWS_BATCH_JOB_ATTEMPT", "2"}};
}
Variables set_by_grid_engine(int task, const std::vector<int>& array) {
  return {{"SGE_TASK_ID", std::to_string(task)},
          {"SGE_TASK_FIRST", std::to_string(array.front())},
          {"SGE_TASK_LAST", std::to_string(array.back())},
          {"SGE_TASK_STEPSIZE", std::to_string(array.size() > 1 ? array[1] - array[0] : 1)}};
}
Variables set_by_pbs(int task, const std::vector<int>&) { return {{"PBS_ARRAY_INDEX", std::to_string(task)}}; }
Variables set_by_torque(int task, const std::vector<int>&) { return {{"PBS_ARRAYID", std::to_string(task)}}; }
Variables set_by_lsf(int task, const std::vector<int>& array) {
  return {{"LSB_JOBINDEX", std::to_string(task)}, {"LSB_JOBINDEX_END", std::to_string(array.back())}};
}
Variables set_by_google(int task, const std::vector<int>& array) {
  return {{"BATCH_TASK_INDEX", std::to_string(task)}, {"BATCH_TASK_COUNT", std::to_string(array.size())}};
}
Variables set_by_cloud_run(int task, const std::vector<int>& array) {
  return {{"CLOUD_RUN_TASK_INDEX", std::to_string(task)},
          {"CLOUD_RUN_TASK_COUNT", std::to_string(array.size())},
          {"CLOUD_RUN_TASK_ATTEMPT", "1"}};
}
Variables set_by_two(int task, const std::vector<int>& array) {
  Variables out = set_by_slurm(task, array);
  out.merge(set_by_kubernetes(task, array));
  return out;
}

/// Arrays that are submitted one after the other for ten shards, each with its tasks.
struct Submissions {
  const char* name;
  Engine engine;
  std::vector<std::vector<int>> arrays;
  std::string text;
  std::optional<std::uint64_t> pinned;
  std::string refusal;  ///< in the error of a task; empty: none has one
};

// Where no task has an error, the ten shards are made, and a task that runs again makes that which it made before.
TEST(Shard, EveryArrayMakesEachShardOrIsRefused) {
  const std::vector<int> ten = tasks(0, 9), from_one = tasks(1, 10);
  const Submissions rows[] = {
      {"Slurm", set_by_slurm, {ten}, "auto/10", {}, ""},
      {"Slurm, steps", set_by_slurm, {tasks(0, 9, 3), tasks(1, 9, 3), tasks(2, 9, 3)}, "auto/10", {}, ""},
      {"Slurm, lists", set_by_slurm, {{0, 1, 2, 5, 8, 9}, {3, 7}, {4, 6}}, "auto/10", {}, ""},
      {"Slurm, some again", set_by_slurm, {ten, {5, 6}, {3, 7}}, "auto/10", {}, ""},
      {"Slurm, restarted", set_by_restarted_slurm, {ten}, "auto/10", {}, ""},
      {"Slurm, from 1", set_by_slurm, {from_one}, "auto/10", {}, "is 10, and the tasks of 10 shards are 0 to 9"},
      {"Slurm, too many", set_by_slurm, {tasks(0, 19)}, "auto/10", {}, "is 19, and the tasks of 10 shards are 0 to 9"},
      {"Slurm, no number", set_by_slurm, {ten}, "auto", {}, "nothing the number of shards"},
      {"Slurm, pinned", set_by_slurm, {tasks(0, 4), tasks(5, 9)}, "auto", 10, ""},
      {"Slurm, pinned otherwise",
       set_by_slurm,
       {tasks(0, 7)},
       "auto/8",
       10,
       "one of 8 shards, and the batch was begun with 10"},
      {"Kubernetes", set_by_kubernetes, {ten, {3}}, "auto/10", {}, ""},
      {"Kubernetes, too many", set_by_kubernetes, {tasks(0, 11)}, "auto/10", {}, "is 11, and the tasks of 10"},
      {"Kubernetes, no number", set_by_kubernetes, {ten}, "auto", {}, "nothing the number of shards"},
      {"Kubernetes, pinned", set_by_kubernetes, {ten}, "auto", 10, ""},
      {"AWS Batch", set_by_aws, {ten, ten}, "auto", {}, ""},
      {"AWS Batch, given", set_by_aws, {ten}, "auto/10", {}, ""},
      {"AWS Batch, too few", set_by_aws, {tasks(0, 3)}, "auto/10", {}, "is 4, and the number of shards 10"},
      {"AWS Batch, pinned otherwise",
       set_by_aws,
       {tasks(0, 7)},
       "auto",
       10,
       "8 shards, and the batch was begun with 10"},
      {"Grid Engine", set_by_grid_engine, {from_one, {5, 6}}, "auto/10", {}, ""},
      {"Grid Engine, step",
       set_by_grid_engine,
       {tasks(1, 10, 3)},
       "auto/10",
       {},
       "SGE_TASK_STEPSIZE is 3, and must be 1"},
      {"Grid Engine, too many",
       set_by_grid_engine,
       {tasks(1, 11)},
       "auto/10",
       {},
       "is 11, and the tasks of 10 shards are 1 to 10"},
      {"PBS", set_by_pbs, {ten, {9}}, "auto/10", {}, ""},
      {"PBS, from 1", set_by_pbs, {from_one}, "auto/10", {}, "is 10, and the tasks of 10 shards are 0 to 9"},
      {"Torque", set_by_torque, {tasks(0, 8, 2), tasks(1, 9, 2)}, "auto/10", {}, ""},
      {"LSF", set_by_lsf, {from_one, {3, 7}}, "auto/10", {}, ""},
      {"LSF, no number", set_by_lsf, {from_one}, "auto", {}, "nothing the number of shards"},
      {"Google Batch", set_by_google, {ten}, "auto", {}, ""},
      {"Cloud Run", set_by_cloud_run, {ten, ten}, "auto", {}, ""},
      {"Cloud Run, too many", set_by_cloud_run, {tasks(0, 11)}, "auto/10", {}, "is 12, and the number of shards 10"},
      {"two engines", set_by_two, {ten}, "auto/10", {}, "are both set"}};
  EXPECT_GE(std::size(rows), 20u);
  for (const Submissions& row : rows) {
    std::map<int, std::string> made;  // by task
    std::set<std::string> shards;
    std::string refused;
    for (const std::vector<int>& array : row.arrays)
      for (const int task : array) {
        const std::string found = shard(row.text, row.engine(task, array), row.pinned);
        if (found.find_first_not_of("0123456789/") != found.npos) {
          refused += found + '\n';
          continue;
        }
        const auto [earlier, is_first] = made.try_emplace(task, found);
        EXPECT_EQ(earlier->second, found) << row.name;
        EXPECT_EQ(shards.insert(found).second, is_first) << row.name << ": " << found << " is made by two tasks";
      }
    EXPECT_NE(refused.find(row.refusal), std::string::npos) << row.name << ": " << refused;
    EXPECT_EQ(refused.empty(), row.refusal.empty()) << row.name << ": " << refused;
    if (row.refusal.empty()) {
      EXPECT_EQ(shards.size(), 10u) << row.name;
    }
  }
}

TEST(Shard, ArraysAreWrittenAsEnginesReadThem) {
  const std::uint64_t some[] = {3, 7, 8, 9, 12, 13};
  EXPECT_EQ(array_of(some), "3,7-9,12,13");
  EXPECT_EQ(array_of(some, 1), "4,8-10,13,14");
  EXPECT_EQ(array_of({}), "");
}

}  // namespace
}  // namespace zoneplate
