// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A channel of a part.
struct ExrPartChannel {
  std::string name;
  ExrType type = ExrType::Half;
  int2 sampling{1, 1};  ///< the columns and rows to a sample
};

/// An attribute of a header: a view of its bytes in the file.
struct ExrAttributeView {
  std::string_view name, type;
  std::span<const std::uint8_t> value;
};

/// What the header of one part of an OpenEXR file states.
struct ExrPart {
  std::string name;                                    ///< files with one part need none
  ExrWindow data, display;                             ///< not sound if the header lacks them
  std::vector<ExrPartChannel> channels;                ///< in the order of the file
  std::optional<std::array<float, 8>> chromaticities;  ///< x and y of red, green, blue and white
  std::string color_space;  ///< the attributes that define its colours, as text; empty: Rec.709
  bool is_deep = false;
  std::vector<ExrAttributeView> attributes;  ///< all of them
  std::span<const std::uint8_t> header;      ///< their bytes, without the zero that ends them

  /// The first attribute of a name; null if there is none.
  const ExrAttributeView* find(std::string_view attribute) const;
};

/// True for the attributes that define the colours of a part: they are its color_space.
bool is_exr_color_attribute(std::string_view name);

/// The parts of an OpenEXR file in its order, which refer to its bytes; only whole headers, thus none of other bytes.
std::vector<ExrPart> read_exr_parts(std::span<const std::uint8_t> bytes);

/// The first of them.
std::optional<ExrPart> read_exr_part(std::span<const std::uint8_t> bytes);

/// The rows of a chunk, which the format packs together.
std::int64_t exr_chunk_rows(const ExrPart& part);

/// The unpacked bytes of a chunk: rows or a tile, of all channels.
std::uint64_t exr_chunk_bytes(const ExrPart& part);

/// The smallest window that contains the display and the data window.
ExrWindow exr_whole_window(const ExrPart& part);

}  // namespace zoneplate
