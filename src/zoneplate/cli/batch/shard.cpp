// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/batch/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate::cli {
namespace {

/// The variables of an engine that runs arrays of tasks.
struct ArrayEngine {
  const char* index;            ///< the variable with the task's number
  std::uint64_t first = 0;      ///< number of the first task of every array
  const char* count = nullptr;  ///< the variable with the size of the whole array, if there is one
};

constexpr ArrayEngine engines[] = {{"SLURM_ARRAY_TASK_ID"},
                                   {"JOB_COMPLETION_INDEX"},
                                   {"AWS_BATCH_JOB_ARRAY_INDEX", 0, "AWS_BATCH_JOB_ARRAY_SIZE"},
                                   {"CLOUD_RUN_TASK_INDEX", 0, "CLOUD_RUN_TASK_COUNT"},
                                   {"BATCH_TASK_INDEX", 0, "BATCH_TASK_COUNT"},
                                   {"PBS_ARRAY_INDEX"},
                                   {"PBS_ARRAYID"},
                                   {"SGE_TASK_ID", 1},
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

Shard shard_of_task(const std::string& text, std::optional<std::uint64_t> count) {
  const ArrayEngine* const engine = find_engine();
  if (engine == nullptr)
    refuse(fmt::format("'{}': no variable of an engine gives the index of the shard; as {}: give i/n, for example 0/10",
                       text, engines[0].index));
  const std::uint64_t task = variable(engine->index, std::getenv(engine->index));
  const char* const size = engine->count != nullptr && !count ? std::getenv(engine->count) : nullptr;
  if (size != nullptr) count = variable(engine->count, size);
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

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view first = std::string_view(text).substr(0, slash);
  const std::optional<std::uint64_t> index = find_whole(first);
  const std::optional<std::uint64_t> count =
      slash == text.npos ? std::nullopt : find_whole(std::string_view(text).substr(slash + 1));
  if (first == "auto" && (slash == text.npos || (count && *count > 0))) return shard_of_task(text, count);
  if (!index || !count || *index >= *count)
    refuse(fmt::format("'{}' is not a shard i/n with i from 0 to n - 1, nor auto/n", text));
  return {*index, *count};
}

}  // namespace zoneplate::cli
