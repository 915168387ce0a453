// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// Serializes values as bytes, for another process of this program.
class Packer {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const std::uint8_t*>(&v);
    bytes_.insert(bytes_.end(), first, first + sizeof v);
  }
  void text(const std::string& t) {
    value(std::uint64_t{t.size()});
    bytes_.insert(bytes_.end(), t.begin(), t.end());
  }
  std::vector<std::uint8_t> bytes() && { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Deserializes the values in the same order.
///
/// Errors    ErrorKind::Failed if the bytes end early.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T v;
    std::memcpy(&v, take(sizeof v).data(), sizeof v);
    return v;
  }
  std::string text() {
    const auto part = take(value<std::uint64_t>());
    return {part.begin(), part.end()};
  }

 private:
  std::span<const std::uint8_t> take(std::uint64_t size) {
    if (size > bytes_.size()) throw Error(ErrorKind::Failed, "the answer of an item's process is cut off");
    const auto part = bytes_.first(static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(part.size());
    return part;
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace zoneplate
