#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/raster/coverage/alpha_coverage.h"
#include "zoneplate/raster/coverage/centroid.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/fragment/fragment_batcher.h"
#include "zoneplate/raster/geometry/bin.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/raster/tile/resolve.h"
#include "zoneplate/raster/types/stage_times.h"

namespace zoneplate {

/// Renders tiles one after the other on one thread, with buffers that stay in that core's cache.
///
/// More samples than `samples_per_pass` at rate *sample* are drawn in several passes over the same triangles; their sum
/// is taken in sample order, so that the passes leave no trace.
class TileRenderer {
 public:
  TileRenderer(const ProjectedDraws& projected, const Bins& bins, const FragmentShader& shader,
               const RasterRules& rules, const Target& target);

  /// Renders the tile with that number in the bins and writes its pixels to the target.
  void render(std::size_t tile);

  std::uint64_t shaded() const { return shader_.shaded(); }
  const StageTimes& times() const { return times_; }

 private:
  /// A blended or masked triangle over one pixel: the samples where it is in front, with its depth at each.
  struct Layer {
    std::uint64_t samples;
    std::uint32_t pixel;
    std::int32_t id;
    std::uint32_t first_depth;  ///< of its depths, in the order of the samples
  };
  struct Over {
    float depth;
    std::int32_t id;
    Linear color;
  };
  /// A layer of one sample, with all samples of its pixel that it wins.
  struct Peel {
    float depth;
    std::int32_t id;
    std::uint64_t samples;
    /// Nearer, or as near and drawn earlier.
    bool operator<(const Peel& o) const { return depth != o.depth ? depth > o.depth : id < o.id; }
  };
  /// Pixels of the tile, ends excluded.
  struct TileRegion {
    int left, top, right, bottom;
    bool contains(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
  };
  /// A pixel's part of layers_; or, where it is deep, more than fit there.
  struct PixelLayers {
    std::uint32_t pixel;
    std::size_t first, last;
    bool is_deep;
    bool empty() const { return first == last && !is_deep; }
  };
  using BlendPixel = void (TileRenderer::*)(const PixelLayers& layers);
  static constexpr std::size_t deadline_stride = 1024;  ///< triangles

  struct BlendedRow {
    std::uint32_t row;
    std::uint32_t end;  ///< of its layers in rows_
  };
  /// A pixel's nearest surface so far, over all passes: what the data planes show.
  struct Nearest {
    float depth = 0;  ///< at the nearest of its samples
    std::int32_t id = no_primitive;
    SamplePosition sample;                 ///< that one
    SamplePosition place;                  ///< where the surface was shaded for it
    std::int32_t first_id = no_primitive;  ///< the owner of the pixel's first sample that has one
    int first_owns = 0;                    ///< samples
  };

  void gather(std::size_t tile);
  void sort_nearest_first(std::vector<const Triangle*>& list);
  void begin_pass(int first_sample, int sample_count);
  void render_pass(int first_sample, int sample_count);
  void draw_opaque();
  void draw_fragments();
  bool materializes_most_blocks();
  void materialize_blocks(const SampleBin& part);
  void draw_masked();
  void draw_masked_layers();
  TileVisibility copy_visibility();
  void test_alpha();
  std::uint64_t rotated_samples(std::uint32_t pixel, int count) const;

  bool wants_color_alone() const;
  /// True if that is so, and all of it can be had from the owners of the samples.
  bool is_plain() const;
  void render_plain();
  void render_visibility();
  void find_rows();
  void find_rows_of(int block);
  void add_block_of_rows(int block, std::int32_t id);
  FragmentSpan row_at(std::uint32_t pixel, std::int32_t id) const;
  void shade_rows();
  void add_row_of_samples(std::uint32_t pixel, std::int32_t id);
  void add_pixel(std::uint32_t pixel);
  void resolve_points();
  bool lists_points() const;
  OwnerRow owner_row_at(int x, int y) const;
  void list_row(const OwnerRow& row);
  void shade_list();
  void sum_list();
  void store_listed(const FragmentOutputs& colors, std::size_t first, std::size_t count);
  void find_weights();
  float weight_of(std::uint32_t samples) const;
  void find_first_points();
  void layer_tile();
  void collect_block_layers();
  bool starts_from_rows(std::uint32_t block) const;
  static bool sort_block(std::span<BlockLayer> layers);
  void blend_blocks(std::uint32_t strip, std::span<const BlockLayer> (&layers)[8]);
  void layer_strip(int top, int bottom);
  bool collect_row_layers(int top, int bottom);
  bool sort_row(std::size_t first, std::size_t last);
  void blend_rows();
  void blend_slow_pixel(const PixelLayers& layers);
  void write_colors();
  template <class Pixel, class Make>
  void write_row(Plane<Pixel>& plane, int y, Make make);
  void write_background(std::size_t tile);

  void find_points();
  void blend(const TileRegion& region, const std::uint8_t* rows, BlendPixel blend_pixel);
  void blend_collected(const TileRegion& region, BlendPixel blend_pixel);
  void blend_samples(const PixelLayers& layers);
  void lay_over(const PixelLayers& layers, Linear* behind);
  void add_layers(std::size_t first, std::size_t last, Linear* behind);
  void peel_layers(std::uint32_t pixel, int sample, Linear& behind);
  void find_next_layers(std::uint32_t pixel, int sample, const Peel& last);
  Peel layer_of(std::span<const Triangle* const> pieces, std::uint32_t pixel, int sample);
  std::size_t collect_layers(AlphaMode alpha_mode, std::size_t first, const TileRegion& region,
                             const std::uint8_t* rows, const TileVisibility& visibility);
  bool make_triangle_in(const Triangle& triangle, const TileRegion& region);
  void find_layer_points(bool is_each_sample);
  void add_points(std::uint32_t pixel, std::int32_t id, std::uint64_t samples, bool is_each_sample,
                  std::vector<Fragment>& points) const;
  void accumulate();
  void add_surfaces(std::uint32_t pixel);
  bool shades_data() const { return target_.normal || target_.uv || target_.albedo; }
  void note_nearest();
  void keep_data(std::uint32_t pixel, std::size_t p);
  void write_data();
  void write_data(std::uint32_t pixel);
  float depth_of(const Fragment& point, std::size_t draw, const Nearest& nearest) const;
  void store_samples(std::uint32_t pixel, int sample, Linear color);
  void store_color(std::uint32_t pixel, std::uint64_t samples, Linear color);
  void store_row(std::uint32_t pixel, int sample, const FragmentOutputs& color, int first);
  void finish();

  bool is_wanted(int x, int y) const {
    return x >= left_ && x < right_ && y >= top_ && y < bottom_ &&
           (!target_.pixel_mask || (*target_.pixel_mask)(tile_x_ + x - target_.x, tile_y_ + y - target_.y));
  }
  Linear mean_of(Linear sum) const {
    return {sum.r / weight_sum_, sum.g / weight_sum_, sum.b / weight_sum_, sum.a / weight_sum_};
  }
  void add_to_sum(std::uint32_t pixel, Linear color) {
    sum_[pixel / 8].set(pixel % 8, sum_[pixel / 8].get(pixel % 8) + color);
  }
  /// True if all eight pixels are to be drawn; rows as in `row_primitive_`, or as columns of blocks.
  bool is_whole_row(int row) const { return row % 8 * 8 >= left_ && row % 8 * 8 + 8 <= right_; }
  bool is_drawn(int block) const {
    const int x = block % 8 * 8, y = block / 8 * 8;
    return x < right_ && x + 8 > left_ && y < bottom_ && y + 8 > top_;
  }
  bool has_layers() const { return !sources_[static_cast<std::size_t>(AlphaMode::Blend)].empty(); }
  Fragment point_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples) const;
  Fragment point_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples, SamplePosition place) const;

  const ProjectedDraws& projected_;
  const Bins& bins_;
  const CoverageKernels& coverage_;
  const ResolveKernels& resolve_;
  const FragmentListKernels& point_lists_;
  const Target& target_;
  const SetupRules setup_;
  const RasterRoom room_;
  const float least_;  ///< transmittance down to which further layers count
  const ShadedPlaces places_;
  FragmentBatcher shader_;
  AlphaDigits digits_;
  FragmentBatcher digit_batcher_;

  StageTimes times_;
  Stopwatch watch_;
  std::size_t tile_ = 0;                             ///< its number in the bins
  int tile_x_ = 0, tile_y_ = 0;                      ///< first pixel of the tile in the picture
  int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;  ///< the part to be drawn, in the tile
  int first_sample_ = 0, pass_samples_ = 0;          ///< of this pass
  std::uint64_t all_samples_ = 0;
  std::vector<const Triangle*> sources_[3];  ///< by Surface
  std::vector<const Triangle*> sorted_;
  TileTriangle tile_triangle_;

  std::vector<float> depth_storage_;
  std::vector<std::int32_t> id_storage_;
  alignas(64) float block_min_depth_[TileVisibility::blocks];
  std::int32_t block_primitive_[TileVisibility::blocks];
  TileVisibility visibility_;
  std::int32_t row_primitive_[tile_pixels / 8];

  std::vector<FragmentSpan> rows_;

  FragmentList list_;
  std::vector<float> samples_weight_;       ///< by set of samples, a bit each
  std::vector<std::uint32_t> listed_rows_;  ///< by their first pixels
  std::vector<Linear> list_sums_;           ///< by pixel: what its listed points add up to

  std::vector<Fragment> points_;
  std::vector<std::uint32_t> first_point_;  ///< by pixel, and the total at the end
  std::vector<Linear> colors_;
  FragmentData data_;        ///< of points_
  FragmentData pixel_data_;  ///< of the nearest surface, by pixel

  std::vector<CoveredPixel> fragments_;
  std::vector<Layer> layers_;
  std::vector<float> layer_depths_;
  std::vector<Fragment> layer_points_;
  std::vector<std::uint32_t> point_of_layer_;
  std::vector<std::uint8_t> is_there_;
  std::vector<std::uint64_t> alpha_samples_;  ///< by point: the samples where alpha lets it be
  std::vector<Linear> layer_colors_;
  std::vector<Over> overs_;
  std::vector<Peel> peeled_;
  std::vector<float> copied_depth_;  ///< of copy_visibility
  std::vector<std::int32_t> copied_id_;

  std::vector<SpanLayer> row_layers_, sorted_row_layers_;
  std::uint8_t is_slow_row_[tile_pixels / 8];
  std::vector<BlendedRow> blended_rows_;
  std::vector<BlockLayer> block_layers_, unsorted_layers_;
  TransparentStack8 strip_layers_[64];  ///< by rows of a strip of blocks
  std::uint64_t other_blocks_ = 0;      ///< a bit for each block whose layers go by rows or pixels

  std::vector<Linear8> sum_;    ///< by eight pixels: weighted sum of samples
  std::vector<Linear8> color_;  ///< by eight pixels: their mean
  std::vector<Linear8> base_;   ///< by eight pixels: the colour of the one surface that owns them, under layers
  std::vector<float> covered_;  ///< by pixel: samples that a surface owns
  std::vector<Nearest> nearest_;
  float weight_sum_ = 0;
  std::vector<float> weights_;
};

}  // namespace zoneplate
