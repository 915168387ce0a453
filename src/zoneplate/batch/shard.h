// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace zoneplate {

/// Every `count`th item of a list, starting with number `index`.
struct Shard {
  std::uint64_t index = 0, count = 1;
  bool has(std::uint64_t item) const { return item % count == index; }
  /// How many of `items` items it has.
  std::uint64_t size_of(std::uint64_t items) const { return items > index ? (items - index + count - 1) / count : 0; }
};

/// Parses "i/n" with i from 0 to n - 1; "auto/n", for which an engine's environment variable gives i; or "auto", for
/// which `pinned` is n, the number of shards that the batch was begun with, or the engine gives n as well.
///
/// i is the index of the task in the whole array, whichever part of it runs: SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX
/// (Kubernetes), AWS_BATCH_JOB_ARRAY_INDEX, CLOUD_RUN_TASK_INDEX, BATCH_TASK_INDEX (Google), PBS_ARRAY_INDEX,
/// PBS_ARRAYID, or one less than SGE_TASK_ID and LSB_JOBINDEX, which begin at 1. n of "auto" is
/// AWS_BATCH_JOB_ARRAY_SIZE, CLOUD_RUN_TASK_COUNT or BATCH_TASK_COUNT. Slurm's SLURM_ARRAY_TASK_COUNT is not used: in
/// an array with a step, or one of tasks that run again, it is the number of those tasks. Grid Engine's arrays with a
/// step are refused: each of their tasks stands for SGE_TASK_STEPSIZE numbers, of which it is given the first.
/// Errors    ErrorKind::Usage naming both numbers if i is not one of 0 to n - 1, n is not `pinned` or the size that
///           the engine gives, or a step is not 1; if no variable or several give i, or none gives n.
Shard parse_shard(const std::string& text, std::optional<std::uint64_t> pinned = {});

/// The specification of an array with the tasks of these shards, in ascending order, for Slurm and PBS: "3,7-9". For
/// engines whose tasks are counted from 1, `first` is 1.
std::string array_of(std::span<const std::uint64_t> shards, std::uint64_t first = 0);

}  // namespace zoneplate
