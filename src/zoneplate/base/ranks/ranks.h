// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "zoneplate/base/ranks/byte_buffer.h"

namespace zoneplate {

/// The processes that render one image together, which are numbered from 0 (the ranks of MPI).
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;  ///< of this process
  virtual int count() const = 0;

  /// Sends to[r] to each other rank r; the result has, by rank, what the others have sent to this one, and nothing from
  /// itself. Every rank makes the same calls, in the same order.
  ///
  /// Requires  a buffer for each rank.
  virtual std::vector<ByteBuffer> exchange(std::span<const ByteBuffer> to) = 0;
};

/// The values of all ranks, by rank.
template <class T>
std::vector<T> all_values(Ranks& ranks, const T& own) {
  std::vector<ByteBuffer> to(static_cast<std::size_t>(ranks.count()));
  for (ByteBuffer& buffer : to) buffer.put(own);
  const std::vector<ByteBuffer> from = ranks.exchange(to);
  std::vector<T> values(from.size(), own);
  for (std::size_t r = 0; r < from.size(); ++r)
    if (static_cast<int>(r) != ranks.rank()) values[r] = ByteReader(from[r].bytes()).take<T>();
  return values;
}

}  // namespace zoneplate
