// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

#include "zoneplate/base/large_array.h"

namespace zoneplate {

/// Bytes that grow at their end. New bytes are not initialised.
class ByteBuffer {
 public:
  ByteBuffer() = default;
  /// Bytes that must be assigned before they are read.
  static ByteBuffer unset(std::size_t size) {
    ByteBuffer buffer;
    buffer.extend(size);
    return buffer;
  }

  std::byte* data() { return memory_.data(); }
  std::size_t size() const { return size_; }
  std::span<const std::byte> bytes() const { return {memory_.data(), size_}; }

  /// Memory for at least `most` bytes at the end, which do not belong to the buffer until `keep`.
  std::byte* reserve(std::size_t most) {
    if (memory_.size() - size_ < most) {
      LargeArray<std::byte> larger = LargeArray<std::byte>::unset(std::max(2 * memory_.size(), size_ + most));
      if (size_ > 0) std::memcpy(larger.data(), memory_.data(), size_);
      memory_ = std::move(larger);
    }
    return memory_.data() + size_;
  }
  /// Keeps the first `count` bytes that reserve gave.
  void keep(std::size_t count) { size_ += count; }

  std::byte* extend(std::size_t count) {
    std::byte* const first = reserve(count);
    keep(count);
    return first;
  }
  void append(std::span<const std::byte> bytes) {
    if (!bytes.empty()) std::memcpy(extend(bytes.size()), bytes.data(), bytes.size());
  }
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(extend(sizeof value), &value, sizeof value);
  }

 private:
  LargeArray<std::byte> memory_;
  std::size_t size_ = 0;
};

/// Reads what was put into a ByteBuffer, from the first byte on.
///
/// Requires  bytes that this program has written: they do not end early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool is_at_end() const { return bytes_.empty(); }
  std::span<const std::byte> rest() const { return bytes_; }
  std::span<const std::byte> take(std::size_t count) {
    assert(count <= bytes_.size());
    const auto part = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return part;
  }
  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace zoneplate
