// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// The variables of an engine that runs arrays of tasks.
struct ArrayEngine {
  const char* index;            ///< the variable with the task's number
  std::uint64_t first = 0;      ///< number of the first task of every array
  const char* count = nullptr;  ///< the variable with the size of the whole array, if there is one
  const char* step = nullptr;   ///< the variable with the number of items of a task, which must be 1
};

constexpr ArrayEngine engines[] = {{"SLURM_ARRAY_TASK_ID"},
                                   {"JOB_COMPLETION_INDEX"},
                                   {"AWS_BATCH_JOB_ARRAY_INDEX", 0, "AWS_BATCH_JOB_ARRAY_SIZE"},
                                   {"CLOUD_RUN_TASK_INDEX", 0, "CLOUD_RUN_TASK_COUNT"},
                                   {"BATCH_TASK_INDEX", 0, "BATCH_TASK_COUNT"},
                                   {"PBS_ARRAY_INDEX"},
                                   {"PBS_ARRAYID"},
                                   {"SGE_TASK_ID", 1, nullptr, "SGE_TASK_STEPSIZE"},
                                   {"LSB_JOBINDEX", 1}};

[[noreturn]] void refuse(const std::string& cause) { throw Error(ErrorKind::Usage, cause); }

std::optional<std::uint64_t> find_whole(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (trouble != std::errc{} || end != text.data() + text.size() || value > 1'000'000'000) return std::nullopt;
  return value;
}

std::uint64_t variable(const char* name, const char* text) {
  const std::optional<std::uint64_t> value = find_whole(text);
  if (!value) refuse(fmt::format("{} is '{}', expected a whole number", name, text));
  return *value;
}

/// The engine whose variable is set. Outside an array, Grid Engine sets "undefined" and LSF 0.
const ArrayEngine* find_engine() {
  const ArrayEngine* found = nullptr;
  for (const ArrayEngine& engine : engines) {
    const char* const text = std::getenv(engine.index);
    if (text == nullptr || *text == 0 || std::string_view(text) == "undefined") continue;
    if (engine.first > 0 && find_whole(text) == 0) continue;
    if (found != nullptr)
      refuse(fmt::format("{} and {} are both set: give the shard as i/n", found->index, engine.index));
    found = &engine;
  }
  return found;
}

void check_pinned(const std::string& text, std::uint64_t count, std::optional<std::uint64_t> pinned) {
  if (pinned && *pinned != count)
    refuse(
        fmt::format("'{}' is one of {} shards, and the batch was begun with {}: give the same number, or another "
                    "folder for --ledger",
                    text, count, *pinned));
}

Shard shard_of_task(const std::string& text, std::optional<std::uint64_t> count, std::optional<std::uint64_t> pinned) {
  const ArrayEngine* const engine = find_engine();
  if (engine == nullptr)
    refuse(fmt::format("'{}': no variable of an engine gives the index of the shard; as {}: give i/n, for example 0/10",
                       text, engines[0].index));
  const std::uint64_t task = variable(engine->index, std::getenv(engine->index));
  if (const char* const size = engine->count != nullptr ? std::getenv(engine->count) : nullptr) {
    const std::uint64_t tasks = variable(engine->count, size);
    if (count.value_or(tasks) != tasks)
      refuse(fmt::format("'{}': {} is {}, and the number of shards {}: give the array as many tasks", text,
                         engine->count, tasks, *count));
    count = tasks;
  }
  if (!count) count = pinned;
  if (count) check_pinned(text, *count, pinned);
  if (const char* const step = engine->step != nullptr ? std::getenv(engine->step) : nullptr;
      step != nullptr && std::string_view(step) != "undefined" && variable(engine->step, step) != 1)
    refuse(fmt::format("'{}': {} is {}, and must be 1: a task is one shard", text, engine->step, step));
  if (!count)
    refuse(
        fmt::format("'{}': {} gives the index of the shard, and nothing the number of shards: give it, for example "
                    "{}/10",
                    text, engine->index, text));
  if (task < engine->first || task - engine->first >= *count)
    refuse(fmt::format("'{}': {} is {}, and the tasks of {} shards are {} to {}", text, engine->index, task, *count,
                       engine->first, engine->first + *count - 1));
  return {task - engine->first, *count};
}

}  // namespace

Shard parse_shard(const std::string& text, std::optional<std::uint64_t> pinned) {
  const std::size_t slash = text.find('/');
  const std::string_view first = std::string_view(text).substr(0, slash);
  const std::optional<std::uint64_t> index = find_whole(first);
  const std::optional<std::uint64_t> count =
      slash == text.npos ? std::nullopt : find_whole(std::string_view(text).substr(slash + 1));
  if (first == "auto" && (slash == text.npos || (count && *count > 0))) return shard_of_task(text, count, pinned);
  if (!index || !count || *index >= *count)
    refuse(fmt::format("'{}' is not a shard i/n with i from 0 to n - 1, nor auto/n", text));
  check_pinned(text, *count, pinned);
  return {*index, *count};
}

std::string array_of(std::span<const std::uint64_t> shards, std::uint64_t first) {
  std::string text;
  for (std::size_t begin = 0; begin < shards.size();) {
    std::size_t end = begin + 1;
    while (end < shards.size() && shards[end] == shards[end - 1] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", shards[begin] + first);
    if (end - begin > 1) text += fmt::format("{}{}", end - begin == 2 ? ',' : '-', shards[end - 1] + first);
    begin = end;
  }
  return text;
}

}  // namespace zoneplate
