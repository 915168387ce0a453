// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/render/render.h"

namespace zoneplate {

/// The report of a job. Times are in milliseconds, in the order of the work.
struct Summary {
  int width = 0, height = 0, threads = 0;
  RenderCounts counts;
  std::vector<std::pair<std::string, double>> times;
  std::vector<std::string> warnings;
  int frames = 1;
  std::string output = {};        ///< the written file; of several frames, the name in the arguments
  float exposure = 1;             ///< the factor that was applied, DisplayOptions::exposure
  std::uint64_t peak_memory = 0;  ///< peak resident memory of the process that did the work, in bytes

  /// The time from the start of reading to the written file.
  double total_ms() const;
};

}  // namespace zoneplate
