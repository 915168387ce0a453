// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "zoneplate/image/pixel.h"
#include "zoneplate/raster/tile/job.h"
#include "zoneplate/raster/tile/visibility.h"

namespace zoneplate {

/// Colours of a tile's spans of eight pixels: linear, premultiplied.
struct TileColors {
  std::vector<Linear8> color;  ///< the weighted mean of the samples
  /// By line of the tile: a bit for each span of eight pixels that is written already, and whose `color` is unset.
  std::array<std::uint8_t, tile_size> written_spans = {};
  std::vector<Linear8> base;    ///< the colour of the one opaque surface that a span shows, before transparent ones
  std::vector<Linear8> sum;     ///< the weighted sum of samples, where they are added one after the other
  std::vector<float> coverage;  ///< by pixel: the number of samples that an opaque surface covers
};

/// Writes the colours to the target's planes: linear, and display-referred. Spans that are written already stay.
void write_colors(const TileJob& job, const TileColors& colors);

/// Writes the target's coverage plane.
void write_coverage(const TileJob& job, const std::vector<float>& coverage);

/// Writes the display-referred background of an empty tile and of the empty tiles that follow it in the row of tiles,
/// in long rows of memory; nothing if the tile before it is empty too.
///
/// Requires  the target stores nothing but colours.
void write_background(const TileSetup& setup, std::size_t tile);

/// Stores the colour of a sample of the pass, with its depth and triangle id, in the target's planes by sample.
void store_sample(const TileJob& job, const TileVisibility& visibility, std::uint32_t pixel, int sample, Linear color);

/// Stores the colour of a set of samples of a pixel. Requires: Target::sample_color.
void store_color(const TileJob& job, std::uint32_t pixel, std::uint64_t samples, Linear color);

/// Stores the colours of one sample of a span; they begin at fragment `first`. Requires: Target::sample_color.
void store_span(const TileJob& job, std::uint32_t pixel, int sample, const FragmentOutputs& color, int first);

}  // namespace zoneplate
