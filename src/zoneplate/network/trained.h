// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace zoneplate::network {

/// What the program contains of numbers that are trained: the files of weights/.
enum class Trained {
  Learned,         ///< the network of upscale/learned
  LearnedFilters,  ///< the table that filters its images
  Smaa,            ///< the network of antialias/post/learned_smaa
  Still,           ///< that of upscale/learned_still
  Table,           ///< the table of `learned-table` (upscale/table)
  TableStill,      ///< that of `learned-table-still`
};

/// The bytes of a file.
std::span<const std::uint8_t> trained_weights(Trained file);

}  // namespace zoneplate::network
