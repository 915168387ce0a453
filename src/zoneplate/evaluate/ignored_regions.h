// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// The regions that are not compared, as they were given.
struct IgnoredInputs {
  std::vector<metrics::IgnoredRegions::Rectangle> rectangles;
  std::vector<std::string> masks;  ///< files
  std::vector<std::string> texts;  ///< all of them, for reports
};

/// Reads the masks.
///
/// Errors    ErrorKind::Input naming a mask and the cause.
metrics::IgnoredRegions read_ignored(const IgnoredInputs& args, Delivery& out);

}  // namespace zoneplate
