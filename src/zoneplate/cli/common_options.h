// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/evaluate/ignored_regions.h"
#include "zoneplate/job/option/option.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate::cli {

// Options that several verbs have.

/// The options --max-memory, --max-pixels, --max-import-seconds, --max-seconds, --sandbox and --no-sandbox of a verb;
/// `subject` is what the limits apply to: "an item", "the run".
std::vector<Option> limit_options(LoadLimits& load, double& seconds, bool& is_sandboxed, const std::string& group,
                                  const std::string& subject);
inline std::vector<Option> limit_options(ReadingLimits& limits, const std::string& subject = "the run") {
  return limit_options(limits.load, limits.seconds, limits.is_sandboxed, "Limits", subject);
}
/// The option --layer of a verb that opens images.
Option layer_option(std::string& layer);

/// The option --ignore.
Option ignore_option(IgnoredInputs& args, const std::string& group);

}  // namespace zoneplate::cli
