// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "zoneplate/raster/coverage/centroid.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/fragment/fragment_batcher.h"
#include "zoneplate/raster/fragment/fragment_list.h"
#include "zoneplate/raster/geometry/bin.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/raster/tile/resolve.h"

namespace zoneplate {

/// The constants of a frame that all of its tiles read. All threads share one.
struct TileSetup {
  /// At rate *sample*, a pattern of more samples than this is drawn in several passes over the same triangles. The
  /// samples are summed in their order, so that the number of passes changes no bit.
  static constexpr int samples_per_pass = 16;

  /// The weights of all subsets of the samples are tabulated for patterns of at most this many samples.
  static constexpr int max_tabulated_samples = 8;

  /// `brightest`: the bound of FragmentShader::brightest, where other processes shade surfaces too.
  TileSetup(const ProjectedDraws& draws, const Bins& binned, const FragmentShader& fragment_shader,
            const RasterRules& raster_rules, const Target& planes, std::optional<float> brightest = {});

  const ProjectedDraws& projected;
  const Bins& bins;
  const FragmentShader& shader;
  const Target& target;
  const CoverageKernels& coverage;
  const ResolveKernels& resolve;
  const FragmentListKernels& fragment_lists;
  const RasterRules rules;
  const float min_transmittance;  ///< transparent fragments behind this transmittance or less are left out
  const CentroidTable centroids;  ///< the shading positions in a pixel

  std::vector<float> weights;  ///< one for each sample of the pattern
  float weight_sum = 0;

  int samples() const { return static_cast<int>(target.samples.size()); }
  /// The most samples that a pass draws.
  int max_pass_samples() const;
  /// The sum of the weights of a set of samples, in their order. Bit 0 of `set` is sample `first` of the pattern.
  float weight_of(std::uint64_t set, int first) const;
  /// The same for first = 0, from a table. Requires: at most max_tabulated_samples samples.
  const float* tabulated_weights() const { return set_weights_.data(); }

  /// Whether the target stores the colour of whole pixels, or of samples; otherwise no fragment is shaded for its
  /// colour.
  bool stores_color() const { return target.color || target.display8 || target.sample_color; }
  /// Whether the target stores results of shading other than colours.
  bool stores_shaded_data() const { return target.stores_shaded_data(); }
  /// Whether the target stores nothing but colours, and all samples are drawn in one pass.
  bool stores_color_alone() const;

 private:
  std::vector<float> set_weights_;
};

/// A rectangle of pixels of a tile. `right` and `bottom` are excluded.
struct TileRect {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool contains(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
  bool is_empty() const { return left >= right || top >= bottom; }
};

/// The part of the sample pattern that one pass draws.
struct SamplePass {
  int first = 0, count = 0;
  std::uint64_t all = 0;  ///< a bit for each sample of the pass; bit 0 is sample `first`
};

/// The work of one tile: its position in the image, the pixels to be drawn, its triangles, and the samples of the
/// current pass. The pixels of a tile have the indices 64 y + x, the spans of eight pixels 8 y + x / 8.
struct TileJob {
  explicit TileJob(const TileSetup& frame) : setup(frame) {}

  const TileSetup& setup;
  std::size_t tile = 0;  ///< index into the bins
  int x = 0, y = 0;      ///< the tile's first pixel in the image
  TileRect drawn;        ///< the part of the tile inside the target
  SamplePass pass;
  std::array<std::vector<const Triangle*>, 3> triangles;  ///< by AlphaMode; the opaque ones roughly nearest first
  std::vector<const Triangle*> sorted;                    ///< scratch memory of begin_tile

  const std::vector<const Triangle*>& triangles_of(AlphaMode mode) const {
    return triangles[static_cast<std::size_t>(mode)];
  }
  bool has_transparency() const { return !triangles_of(AlphaMode::Blend).empty(); }

  /// Whether the target's pixel mask and rectangle include this pixel of the tile.
  bool draws(int px, int py) const {
    const Target& target = setup.target;
    return drawn.contains(px, py) && (!target.pixel_mask || (*target.pixel_mask)(x + px - target.x, y + py - target.y));
  }
  /// Whether all eight pixels of a span of this column lie in `drawn`; columns are those of the blocks.
  bool is_whole_column(int column) const { return column % 8 * 8 >= drawn.left && column % 8 * 8 + 8 <= drawn.right; }
  bool overlaps_block(int block) const {
    const int bx = block % 8 * 8, by = block / 8 * 8;
    return bx < drawn.right && bx + 8 > drawn.left && by < drawn.bottom && by + 8 > drawn.top;
  }

  /// Coordinates of a pixel of the tile in the target's planes.
  int target_x(std::uint32_t pixel) const { return x + static_cast<int>(pixel % tile_size) - setup.target.x; }
  int target_y(std::uint32_t pixel) const { return y + static_cast<int>(pixel / tile_size) - setup.target.y; }

  /// The triangle as seen from the tile, at the samples of the pass.
  void make_triangle(const Triangle& triangle, TileTriangle& out) const {
    make_tile_triangle(triangle, setup.target.samples.data() + pass.first, pass.count, x, y, out);
  }
  /// The same restricted to a rectangle; false if the triangle's bounds lie outside of it.
  bool make_triangle_in(const Triangle& triangle, const TileRect& rect, TileTriangle& out) const;

  /// A fragment of a pixel at a position inside it.
  Fragment fragment_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples, SamplePosition position) const {
    const std::int32_t left = (x + static_cast<std::int32_t>(pixel % tile_size)) * 256;
    const std::int32_t top = (y + static_cast<std::int32_t>(pixel / tile_size)) * 256;
    return {left + position.x, top + position.y, id, pixel, samples};
  }
  /// The same at the position where a triangle is shaded that owns these samples of the pixel.
  Fragment fragment_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples) const {
    const bool is_whole = samples == pass.all && !setup.target.is_per_sample;
    const CentroidTable& places = setup.centroids;
    return fragment_at(pixel, id, samples, is_whole ? places.whole : places.of(samples, pass.first));
  }
  /// Appends one fragment for all of these samples, or one for each of them.
  void add_fragments(std::uint32_t pixel, std::int32_t id, std::uint64_t samples, bool is_per_sample,
                     std::vector<Fragment>& out) const;
  /// The fragments of eight pixels that a triangle owns as a whole, from `pixel` on.
  FragmentSpan span_at(std::uint32_t pixel, std::int32_t id) const;
};

/// Begins a tile: sets its position, its rectangle and its triangles. The vectors of `job` are reused.
void begin_tile(std::size_t tile, TileJob& job);

/// Begins a pass over the samples [first, first + count).
void begin_pass(int first, int count, TileJob& job);

/// Triangles between two checks of the deadline.
inline constexpr std::size_t deadline_stride = 1024;

}  // namespace zoneplate
