// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/exr/exr_library.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The values of channels, which are handed on as floats.
enum class ExrValues {
  Finite,  ///< as floats, in which NaN becomes 0, infinity 65504
  Floats,  ///< as floats
  Bits,    ///< as floats, but whole numbers as their bits
  Stored,  ///< all as their bits
};

/// What is decoded of a file.
struct ExrSelection {
  int part = 0;
  std::vector<std::string> names;  ///< of the channels; empty: one that the file lacks
  ExrLayer::Kind kind = ExrLayer::Kind::Colors;
  ExrValues values = ExrValues::Floats;
  std::optional<ExrWindow> window = std::nullopt;  ///< none: the display window

  /// Channels are handed on four by four, as pixels.
  std::size_t groups() const { return (names.size() + 3) / 4; }
};

/// The part of a file that is decoded, and the pixels that are handed on.
struct ExrPlan {
  ExrPart part;
  ExrWindow out;
};

/// Decodes the rows of the window, in this process, and calls `take_row` for each: pixels of one group of channels
/// after the other. Those outside the data window are transparent black. Chunks that have no row of the window are not
/// read.
///
/// Errors    ExrRefusal, before the first row; that of the deadline.
void read_exr_rows(const ExrLibrary& library, std::span<const std::uint8_t> bytes, const ExrPlan& plan,
                   const ExrSelection& selection, const std::function<void(std::span<const Linear>)>& take_row);

/// The bytes that read_exr_rows allocates at most.
std::uint64_t exr_reader_memory(const ExrPlan& plan, const ExrSelection& selection);

}  // namespace zoneplate
