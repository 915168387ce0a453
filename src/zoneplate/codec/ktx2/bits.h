// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate::ktx2 {

/// The place of a file in error messages.
struct Place {
  const std::string& name;
  [[noreturn]] void fail(const std::string& flaw) const {
    throw Error(ErrorKind::Input, name + ": corrupt KTX2 image: " + flaw);
  }
};

/// The bits of bytes, the lowest first.
class BitReader {
 public:
  BitReader(std::span<const std::uint8_t> bytes, const Place& place) : bytes_(bytes), place_(place) {}

  /// Requires  count <= 16.
  std::uint32_t take(unsigned count) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < count; ++i) value |= bit() << i;
    return value;
  }
  std::uint32_t bit() {
    if (at_ / 8 >= bytes_.size()) place_.fail("its data end early");
    const std::uint32_t value = bytes_[at_ / 8] >> (at_ % 8) & 1u;
    ++at_;
    return value;
  }
  const Place& place() const { return place_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  Place place_;
};

}  // namespace zoneplate::ktx2
