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

  // The functions below require applies(). Spans are numbered in the order in which they are added.

  /// Adds a span, by its first pixel, also to TileColors::written_spans.
  void add(std::uint32_t pixel) {
    const std::uint32_t x = pixel % tile_size, y = pixel / tile_size;
    colors_.written_spans[y] |= static_cast<std::uint8_t>(1u << x / 8);
    spans_[count_++] = pixels_ + (first_ + static_cast<std::ptrdiff_t>(y) * stride_ + static_cast<std::ptrdiff_t>(x));
  }
  /// Fetches the memory of spans into the cache. To be called long before `present`: the lines of an image lie in
  /// different pages, and waiting for them would take longer than presenting.
  void prefetch(std::span<const std::uint32_t> numbers) const;
  /// Writes the pixels of spans, whose colours follow each other in `color`. At most FragmentBatch::groups spans.
  void present(std::span<const std::uint32_t> numbers, const FragmentOutputs& color) const;

 private:
  const Target& target_;
  TileColors& colors_;
  Rgba8* pixels_ = nullptr;    ///< of Target::display8
  std::ptrdiff_t first_ = 0;   ///< index of the tile's first pixel, which may lie outside the target
  std::ptrdiff_t stride_ = 0;  ///< pixels from one line to the next
  std::size_t count_ = 0;
  Rgba8* spans_[tile_pixels / FragmentBatch::group];  ///< the first pixels of `count_` spans
};

}  // namespace zoneplate
