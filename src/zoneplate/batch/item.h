// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include "zoneplate/job/job.h"

namespace zoneplate {

/// A rendering, alone or of a batch: what its process may use, and what is known of its files.
struct BatchItem : Job {
  std::uint64_t number = 0;  ///< of the item in its batch
  bool skip_existing = false;
  std::string ledger;  ///< folder of batch/ledger.h; empty: none is kept
  double grace = 0;    ///< seconds after SIGTERM in which an item may be finished
  std::string given;   ///< the options that determine the images, as they were given, in lines "--size=512"
  double max_seconds = std::numeric_limits<double>::infinity();  ///< limit of a whole item
  bool is_sandboxed = true;                                      ///< if the kernel supports sandboxes
};

/// What a run says while it works.
struct RunEvents {
  std::function<void(std::string_view stage, double done)> progress = {};  ///< null: progress is not measured
  std::function<void(const std::string& message)> warn;
};

}  // namespace zoneplate
