// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace zoneplate {

/// The digest SHA-256 of bytes that arrive in parts. It is our own, since the program links no library that has it.
///
/// Source    FIPS 180-4, Secure Hash Standard, 2015, section 6.2.
class Sha256 {
 public:
  void add(std::span<const std::uint8_t> bytes);
  /// The digest of all bytes so far as 64 hexadecimal digits, as sha256sum prints it.
  ///
  /// Requires  nothing is added after it.
  std::string hex();

 private:
  void add_block(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t used_ = 0;  ///< of `block_`
  std::uint64_t bytes_ = 0;
};

/// The digest of a text.
std::string sha256_of(std::string_view text);

}  // namespace zoneplate
