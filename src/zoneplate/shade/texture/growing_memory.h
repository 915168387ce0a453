#pragma once

#include <cstddef>
#include <utility>

namespace zoneplate {

/// Zeroed memory that grows where it lies: its addresses are reserved at once, its bytes are taken from the front on
/// when they are needed. What is reserved and not taken counts towards no limit of memory.
class GrowingMemory {
 public:
  /// Reserves nothing.
  GrowingMemory() = default;
  /// Reserves `size` bytes, on a cache line's start; of many, in large pages where the system has any.
  /// Errors    bad_alloc where there are not as many addresses.
  explicit GrowingMemory(std::size_t size);
  ///@{
  /// Takes over the memory; it stays at its address.
  GrowingMemory(GrowingMemory&& other) noexcept { *this = std::move(other); }
  GrowingMemory& operator=(GrowingMemory&& other) noexcept;
  ///@}
  ~GrowingMemory();

  /// Takes memory up to the first `size` bytes; it is zero.
  /// Requires  no more than is reserved.
  /// Errors    bad_alloc; what was taken before stays.
  void grow(std::size_t size);

  /// The first byte, which never moves; null if nothing was reserved.
  std::byte* data() const { return data_; }

 private:
  void* mapped_ = nullptr;  ///< with what is before the first large page
  std::size_t mapped_size_ = 0;
  std::byte* data_ = nullptr;
  std::size_t taken_ = 0;
};

}  // namespace zoneplate
