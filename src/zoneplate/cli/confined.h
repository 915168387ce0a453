// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "zoneplate/cli/progress.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate::cli {

/// What a confined process may do, and where its files go.
struct ConfinedRun {
  std::string name;  ///< the input, the prefix of messages about limits
  ReadingLimits limits;
  std::vector<std::string> readable;  ///< files and folders
  std::vector<std::string> outputs;   ///< the files that it may save
  bool are_results = false;           ///< each output is a result: saved at once. Else all when the work ends, or none
  Progress* progress = nullptr;       ///< where it reports its progress
  std::function<void()> open = {};    ///< runs in the process before it is confined
  /// Takes the files of other names than `outputs`; throws for a name that it does not accept. Null: there are none.
  std::function<void(const std::string& name, std::vector<std::uint8_t> bytes)> take = {};
  /// Takes prepared environments for the cache. Null: there are none.
  std::function<void(std::uint64_t key, std::vector<std::uint8_t> bytes)> take_environment = {};
};

/// Runs `work` in a process with these limits (item_process.h), prints and saves what it delivers, and returns its
/// result.
///
/// If the work needs a library, that is opened here, and the work is restarted.
/// Errors    those of `work`, also PartialFailure and Difference; of its limits as those of ItemProcess::next; those of
///           printing and saving; ErrorKind::Failed for a file that it may not save.
std::vector<std::uint8_t> run_confined(const ConfinedRun& run, const std::function<void(Delivery&)>& work);

}  // namespace zoneplate::cli
