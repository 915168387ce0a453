// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/cli/args.h"
#include "zoneplate/cli/process/confined.h"
#include "zoneplate/metrics/ignored.h"

namespace zoneplate::cli {

/// The regions that a verb does not compare, as they were given.
struct IgnoreArgs {
  std::vector<metrics::IgnoredRegions::Rectangle> rectangles;
  std::vector<std::string> masks;  ///< files
  std::vector<std::string> texts;  ///< all of them, for reports
};

/// The option --ignore.
Option ignore_option(IgnoreArgs& args, const std::string& group);

/// Reads the masks.
///
/// Errors    ErrorKind::Input naming a mask and the cause.
metrics::IgnoredRegions read_ignored(const IgnoreArgs& args, Delivery& out);

}  // namespace zoneplate::cli
