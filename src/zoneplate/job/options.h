// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/job/job.h"
#include "zoneplate/job/option/option.h"

namespace zoneplate {

/// The options that describe a rendering, by groups: the rows of the command's parser, help, completions and manual, of
/// manifests and configurations, and of the interfaces for C and Python. Each sets members of `job`; --quality sets
/// several, which later ones change. The result refers to `job`.
std::vector<Option> job_options(Job& job);

/// The options --max-memory, --max-pixels and --max-import-seconds; `subject` is what the limits apply to: "an item".
std::vector<Option> reading_options(LoadLimits& limits, const std::string& group, const std::string& subject);

/// The option --allow-path of what reads models.
Option allow_path_option(LoadLimits& limits, const std::string& group = "Limits");

}  // namespace zoneplate
