// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

namespace zoneplate {

/// Zeroed memory that grows in place: its addresses are reserved at once, its bytes are committed from the front on as
/// needed. Memory that is reserved but not committed counts towards no memory limit.
class GrowingMemory {
 public:
  /// Reserves nothing.
  GrowingMemory() = default;
  /// Reserves `size` bytes, aligned to a cache line; large sizes use large pages where the system has them.
  /// Errors    bad_alloc where the address space is too small.
  explicit GrowingMemory(std::size_t size);
  ///@{
  /// Takes over the memory; it stays at its address.
  GrowingMemory(GrowingMemory&& other) noexcept { *this = std::move(other); }
  GrowingMemory& operator=(GrowingMemory&& other) noexcept;
  ///@}
  ~GrowingMemory();

  /// Commits the first `size` bytes; new bytes are zero.
  /// Requires  `size` is at most the reserved size.
  /// Errors    bad_alloc; the bytes committed before stay.
  void grow(std::size_t size);

  /// The first byte, which never moves; null if nothing was reserved.
  std::byte* data() const { return data_; }

 private:
  void* mapped_ = nullptr;  ///< the whole mapping, which may begin before the first large page
  std::size_t mapped_size_ = 0;
  std::byte* data_ = nullptr;
  std::size_t taken_ = 0;
};

}  // namespace zoneplate
