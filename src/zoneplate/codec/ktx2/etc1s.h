// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/codec/ktx2/bits.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::ktx2 {

/// A canonical Huffman code.
class HuffmanCode {
 public:
  HuffmanCode() = default;
  /// Reads the lengths of the codes, which are packed themselves. Errors: as Place::fail.
  explicit HuffmanCode(BitReader& bits);
  std::uint32_t decode(BitReader& bits) const;

 private:
  static constexpr unsigned longest = 16;
  HuffmanCode(std::span<const std::uint8_t> lengths, const Place& place);

  std::array<std::uint32_t, longest + 1> count_{};  ///< codes of each length
  std::vector<std::uint16_t> symbols_;              ///< by length, then by symbol
};

/// The code books that all images of a file share.
struct BasisGlobals {
  struct Endpoint {
    std::uint8_t red, green, blue, table;
  };
  using Selector = std::array<std::uint8_t, 4>;  ///< a byte for each row, two bits a texel

  std::vector<Endpoint> endpoints;
  std::vector<Selector> selectors;
  HuffmanCode endpoint_prediction, endpoint_delta, selector, selector_run;
  std::uint32_t history_size = 0;
};

/// The parts of the global data.
struct BasisSections {
  std::uint32_t endpoint_count, selector_count;
  std::span<const std::uint8_t> endpoints, selectors, tables;
};
BasisGlobals read_basis_globals(const BasisSections& sections, const Place& place);

/// Decodes a slice to the first three channels of an image, or its green to the fourth.
void decode_etc1s(const BasisGlobals& globals, std::span<const std::uint8_t> slice, bool is_alpha, const Place& place,
                  Rgba8Image& image);

}  // namespace zoneplate::ktx2
