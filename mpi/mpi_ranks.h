// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/base/ranks/ranks.h"

namespace zoneplate {

/// The ranks of MPI_COMM_WORLD.
///
/// Requires  MPI is initialised, and used by one thread at a time.
class MpiRanks : public Ranks {
 public:
  MpiRanks();
  int rank() const override { return rank_; }
  int count() const override { return count_; }
  std::vector<ByteBuffer> exchange(std::span<const ByteBuffer> to) override;

  /// The number of ranks on this machine.
  int count_on_machine() const;
  /// The bytes that this rank has sent to others.
  std::uint64_t sent_bytes() const { return sent_bytes_; }

 private:
  int rank_ = 0, count_ = 1;
  std::uint64_t sent_bytes_ = 0;
};

}  // namespace zoneplate
