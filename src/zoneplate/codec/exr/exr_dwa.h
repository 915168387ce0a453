// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The samples of one channel in a chunk.
struct DwaChannel {
  std::string_view name;
  ExrType type = ExrType::Half;
  int width = 0, height = 0;
  int row_step = 1;        ///< rows of the image to a row of samples
  bool is_linear = false;  ///< as the header states; lossy values are stored as they are
};

/// Unpacks chunks of DWAA and DWAB, which libOpenEXRCore 3.1 does not.
///
/// R, G and B of a layer, Y, RY and BY are sums of 8 × 8 cosines of values on a perceptual scale, as Y'CbCr where there
/// are all three; A is run-length encoded; other channels are deflated. The first coefficients of all blocks are
/// deflated, the others Huffman encoded or deflated.
/// Exact     to a unit in the last place of perceptual halves, 0.24 % of the value, by which OpenEXR's sums may differ;
///           values beyond the range of halves are clamped.
/// Source    OpenEXR's ImfDwaCompressor.cpp, ImfHuf.cpp and dwaLookups.cpp: the format is published as their source.
class DwaDecoder {
 public:
  DwaDecoder();

  /// The chunk as if it were not packed: row by row, those channels that have samples in it one after the other, from
  /// row `first_row` of the image on. False if it is damaged.
  bool unpack(std::span<const std::uint8_t> packed, std::span<const DwaChannel> channels, int first_row,
              std::span<std::uint8_t> out) const;

 private:
  std::vector<std::uint16_t> linear_;  ///< halves by the bits of perceptual halves
};

}  // namespace zoneplate
