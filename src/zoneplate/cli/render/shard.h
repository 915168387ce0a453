// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace zoneplate::cli {

/// Every `count`th item of a list, from number `index` on.
struct Shard {
  std::uint64_t index = 0, count = 1;
  bool has(std::uint64_t item) const { return item % count == index; }
};

/// "i/n" with i from 0 to n - 1, or "auto": what Slurm (an array's task) or Kubernetes (an indexed job's, with the
/// number after a slash: "auto/8") say in the environment.
///
/// Errors    ErrorKind::Usage.
Shard parse_shard(const std::string& text);

}  // namespace zoneplate::cli
