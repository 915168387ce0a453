// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace zoneplate::cli {

/// Every `count`th item of a list, starting with number `index`.
struct Shard {
  std::uint64_t index = 0, count = 1;
  bool has(std::uint64_t item) const { return item % count == index; }
  /// How many of `items` items it has.
  std::uint64_t size_of(std::uint64_t items) const { return items > index ? (items - index + count - 1) / count : 0; }
};

/// Parses "i/n" with i from 0 to n - 1, or "auto", which uses the environment variables of Slurm (an array's task) or
/// Kubernetes (the index of an indexed job, with the count after a slash: "auto/8").
///
/// Errors    ErrorKind::Usage.
Shard parse_shard(const std::string& text);

}  // namespace zoneplate::cli
