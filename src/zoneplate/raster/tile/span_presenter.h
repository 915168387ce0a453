// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "zoneplate/raster/tile/output.h"

namespace zoneplate {

/// Writes the display-referred colours of whole spans of opaque surfaces right after they are shaded, while their
/// linear colours are in the first-level cache.
///
/// Applies where nothing else reads these colours: only 8-bit colours are stored, once per pixel, and no transparent
/// surface lies in the tile. The sum of the samples' weights must be a power of two, so that the mean over the samples
/// changes no bit of a colour.
class SpanPresenter {
 public:
  SpanPresenter(const TileJob& job, TileColors& colors);

  bool applies() const { return pixels_ != nullptr; }

  // The functions below require applies().

  /// Adds a span, by its first pixel, to TileColors::written_spans.
  void mark(std::uint32_t pixel) {
    colors_.written_spans[pixel / tile_size] |= static_cast<std::uint8_t>(1u << pixel % tile_size / 8);
  }
  /// Fetches the memory of the pixels of spans[numbers[i]] into the cache. To be called long before `present`: the
  /// lines of an image lie in different pages, and waiting for them would take longer than presenting.
  void prefetch(std::span<const FragmentSpan> spans, std::span<const std::uint32_t> numbers) const;
  /// Writes the pixels of spans[numbers[i]], whose colours follow each other in `color`. At most FragmentBatch::groups
  /// spans.
  void present(std::span<const FragmentSpan> spans, std::span<const std::uint32_t> numbers,
               const FragmentOutputs& color) const;

 private:
  Rgba8* address(std::uint32_t pixel) const {
    const auto y = static_cast<std::ptrdiff_t>(pixel / tile_size), x = static_cast<std::ptrdiff_t>(pixel % tile_size);
    return pixels_ + (first_ + y * stride_ + x);
  }

  const Target& target_;
  TileColors& colors_;
  Rgba8* pixels_ = nullptr;    ///< of Target::display8
  std::ptrdiff_t first_ = 0;   ///< index of the tile's first pixel, which may lie outside the target
  std::ptrdiff_t stride_ = 0;  ///< pixels from one line to the next
};

}  // namespace zoneplate
