// SPDX-License-Identifier: Apache-2.0
// The exact image, tile by tile: the candidates of each pixel, its visible polygons, their colours, and the sum.
#include "zoneplate/antialias/reference/analytic/draw.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>

#include "zoneplate/antialias/reference/analytic/candidates.h"
#include "zoneplate/antialias/reference/analytic/colors.h"
#include "zoneplate/antialias/reference/analytic/crowd.h"
#include "zoneplate/antialias/reference/analytic/fragments.h"
#include "zoneplate/antialias/reference/analytic/masks.h"
#include "zoneplate/antialias/reference/analytic/regions.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/coverage/coverage.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t enough_fragments = 2048;   // fragments that are shaded together
constexpr std::size_t mixed_primitives = 32768;  // primitives of a tile that is not drawn all at once
constexpr std::size_t enough_masked = 8192;      // polygons and alpha queries that are resolved together

/// The data that all tiles share.
struct Whole {
  const CustomDraw& drawing;
  const ProjectedDraws& projected;
  const TileTriangles& triangles;
  const Target& target;
  const PolynomialFilter& filter;
  const AnalyticOptions& options;
  std::optional<DisplayLight> display_light;
};

/// The part of a tile that is drawn, extended by the neighbouring pixels that contribute to it.
PixelRect drawn_rect(const Whole& whole, std::size_t tile) {
  const TileTriangles& t = whole.triangles;
  const Target& target = whole.target;
  const int x = (t.first_column() + static_cast<int>(tile) % t.columns()) * tile_size;
  const int y = (t.first_row() + static_cast<int>(tile) / t.columns()) * tile_size;
  return {std::max(x, target.x), std::max(y, target.y), std::min(x + tile_size, target.x + target.width),
          std::min(y + tile_size, target.y + target.height)};
}

PixelRect rect_around(const PixelRect& r, int radius, Viewport viewport) {
  return {std::max(r.left - radius, 0), std::max(r.top - radius, 0), std::min(r.right + radius, viewport.width),
          std::min(r.bottom + radius, viewport.height)};
}

int fine_grid(const Whole& whole) { return std::max(whole.options.shading, whole.options.mask); }

/// Textures are filtered over the footprint of a part of a pixel, or of the whole pixel if the options request it.
Footprints footprints(const Whole& whole) {
  if (!whole.drawing.options.sample_footprint) return {};
  const float fine = 1 / static_cast<float>(fine_grid(whole));
  return {.part = 1 / static_cast<float>(whole.options.shading),
          .fine = fine / 2,
          .alpha = fine / (4 * AlphaEdges::cells),
          .alpha_part = fine};
}

/// The sums of a pixel.
struct PixelSum {
  double r = 0, g = 0, b = 0, a = 0;
  double covered = 0;   ///< area covered by surfaces that are not blended
  double variance = 0;  ///< variance of the sampled contributions
};

/// Samples cost little compared with their alpha tests, so that fragments are shaded in parts of half the side.
int crowd_grid(const Whole& whole) { return std::min(2 * fine_grid(whole), 64); }

Footprints crowd_footprints(const Whole& whole) {
  Footprints out = footprints(whole);
  if (whole.drawing.options.sample_footprint) out.fine = 0.5f / static_cast<float>(crowd_grid(whole));
  return out;
}

class TileIntegrator {
 public:
  explicit TileIntegrator(const Whole& whole)
      : whole_(whole),
        list_(whole.filter, whole.options.shading),
        masked_list_(whole.filter, whole.options.shading),
        colors_(whole.projected, whole.drawing.shader, whole.target, footprints(whole)),
        masked_colors_(whole.projected, whole.drawing.shader, whole.target, footprints(whole)),
        masks_(whole.projected, whole.drawing.shader, whole.target, fine_grid(whole), footprints(whole)),
        crowd_(whole.projected, whole.drawing.shader, whole.target, whole.filter, whole.options.shading,
               crowd_grid(whole), crowd_footprints(whole)) {}

  void draw(std::size_t tile) {
    if (whole_.triangles.of_tile(tile).empty()) return;
    drawn_ = drawn_rect(whole_, tile);
    const PixelRect around = rect_around(drawn_, whole_.filter.radius(), whole_.target.viewport);
    sum_.assign(static_cast<std::size_t>(drawn_.width()) * static_cast<std::size_t>(drawn_.height()), {});
    const int rows = rows_at_once(whole_.triangles.of_tile(tile).size());
    for (int top = around.top; top < around.bottom; top += rows)
      draw_rows(tile, {around.left, top, around.right, std::min(top + rows, around.bottom)});
    add_fragments();
    write();
  }

  std::uint64_t shaded() const {
    return colors_.shaded() + masked_colors_.shaded() + masks_.shaded() + crowd_.shaded();
  }

 private:
  /// Tiles with many triangles are drawn a few rows at a time, which bounds the memory.
  static int rows_at_once(std::size_t triangles) {
    return triangles <= mixed_primitives ? 2 * tile_size : triangles <= 8 * mixed_primitives ? 8 : 1;
  }

  void draw_rows(std::size_t tile, const PixelRect& rect) {
    growing("triangles of a row of pixels", [&] {
      whole_.triangles.make(tile, rect.top, rect.bottom, triangles_);
      candidates_.find(triangles_, rect);
    });
    std::uint32_t pixel = 0;
    for (int y = rect.top; y < rect.bottom; ++y) {
      check_deadline();
      for (int x = rect.left; x < rect.right; ++x) add_pixel(pixel++, x, y);
    }
  }

  void add_pixel(std::uint32_t pixel, int x, int y) {
    const auto candidates = candidates_.of_pixel(pixel);
    if (candidates.empty()) return;
    const ScreenTriangle& nearest = triangles_[candidates[0].triangle];
    if (candidates.size() == 1 && candidates[0].covers_pixel && nearest.alpha_mode == AlphaMode::Opaque) {
      list_.add_whole(nearest.shape.id, x, y);
    } else {
      here_.clear();
      for (const PixelCandidates::Candidate& c : candidates)
        here_.push_back(at_pixel(triangles_[c.triangle], c.covers_pixel, x, y));
      if (!add_polygons(x, y)) add_samples(x, y);
    }
    if (list_.fragments().size() >= enough_fragments || masks_.size() >= enough_masked) add_fragments();
  }

  /// Adds the pixel's visible polygons. Returns false, and adds nothing, if the pixel is too crowded.
  bool add_polygons(int x, int y) {
    const auto is_masked = [](const PixelTriangle& t) { return t.alpha_mode == AlphaMode::Mask; };
    if (std::ranges::count_if(here_, is_masked) > std::ptrdiff_t{MaskedPolygons::max_triangles}) return false;
    list_.begin_pixel(x, y);
    masks_.begin_pixel(x, y);
    if (regions_.find(here_, [&](const PixelCells& cells) { return add(cells); })) return true;
    list_.abandon_pixel();
    masks_.abandon_pixel();
    return false;
  }

  bool add(const PixelCells& cells) {
    for (const PixelCells::Cell& cell : cells.cells()) {
      if (cell.layers == 0) continue;
      layers_.clear();
      bool is_masked = false;
      for (const std::uint32_t number : cells.layers_of(cell)) {
        const PixelTriangle& t = cells.triangle(number);
        layers_.push_back({t.id, t.alpha_mode});
        is_masked = is_masked || t.alpha_mode == AlphaMode::Mask;
      }
      if (!is_masked)
        list_.add(cell.polygon, layers_);
      else if (!masks_.add(cell.polygon, layers_))
        return false;
    }
    return true;
  }

  void add_samples(int x, int y) {
    if (whole_.filter.radius() > 0) add_fragments();  // contributions are added in the order of the neighbouring pixels
    crowd_.find(here_, x, y, whole_.display_light ? &*whole_.display_light : nullptr);
    if (drawn_.contains(x, y)) sum_at(x, y).covered += crowd_.covered();
    for_around(x, y, [&](PixelSum& s, std::size_t k) {
      const CrowdSampler::Share& share = crowd_.shares()[k];
      s.r += share.r, s.g += share.g, s.b += share.b, s.a += share.a, s.variance += share.variance;
    });
  }

  /// Shades the fragments and adds them to the neighbouring pixels, in the order of the fragments' own pixels.
  void add_fragments() {
    if (masks_.size() > 0) masks_.resolve(masked_list_);
    colors_.find(list_.table());
    masked_colors_.find(masked_list_.table());
    const auto masked = masked_list_.fragments();
    std::size_t next = 0;
    for (std::size_t i = 0; i < list_.fragments().size(); ++i) {
      const AreaFragment& f = list_.fragments()[i];
      for (; next < masked.size() && std::pair(masked[next].y, masked[next].x) < std::pair(f.y, f.x); ++next)
        add(masked_list_, masked_colors_, next);
      add(list_, colors_, i);
    }
    for (; next < masked.size(); ++next) add(masked_list_, masked_colors_, next);
    list_.clear();
    masked_list_.clear();
    masks_.clear();
  }

  void add(const AreaFragmentList& list, const AreaFragmentColors& colors, std::size_t i) {
    const AreaFragment& f = list.fragments()[i];
    if (list.table().layers_of(f).back().alpha_mode != AlphaMode::Blend && drawn_.contains(f.x, f.y))
      sum_at(f.x, f.y).covered += f.moments.area;
    const Linear color = whole_.display_light ? (*whole_.display_light)(colors.color(i)) : colors.color(i);
    const double* weight = list.weights_of(i).data();
    for_around(f.x, f.y, [&](PixelSum& s, std::size_t k) {
      s.r += weight[k] * color.r, s.g += weight[k] * color.g, s.b += weight[k] * color.b, s.a += weight[k] * color.a;
    });
  }

  /// Calls use(sum, k) for the drawn pixels around a pixel, k by rows from the top.
  template <class Use>
  void for_around(int px, int py, Use use) {
    const int radius = whole_.filter.radius();
    std::size_t k = 0;
    for (int y = py - radius; y <= py + radius; ++y)
      for (int x = px - radius; x <= px + radius; ++x, ++k)
        if (drawn_.contains(x, y)) use(sum_at(x, y), k);
  }

  PixelSum& sum_at(int x, int y) {
    return sum_[static_cast<std::size_t>(y - drawn_.top) * static_cast<std::size_t>(drawn_.width()) +
                static_cast<std::size_t>(x - drawn_.left)];
  }

  void write() {
    const Target& target = whole_.target;
    for (int y = drawn_.top; y < drawn_.bottom; ++y)
      for (int x = drawn_.left; x < drawn_.right; ++x) {
        const PixelSum& s = sum_at(x, y);
        const double share = whole_.filter.share_inside(x, target.viewport.width) *
                             whole_.filter.share_inside(y, target.viewport.height);
        const auto mean = [&](double v) { return static_cast<float>(v / share); };
        const int column = x - target.x, row = y - target.y;
        (*target.color)(column, row) = {mean(s.r), mean(s.g), mean(s.b), mean(s.a)};
        if (target.coverage) (*target.coverage)(column, row) = static_cast<float>(s.covered);
        if (whole_.drawing.error) (*whole_.drawing.error)(column, row) = mean(std::sqrt(s.variance));
      }
  }

  const Whole& whole_;
  AreaFragmentList list_, masked_list_;  ///< without and with alpha-tested surfaces
  AreaFragmentColors colors_, masked_colors_;
  MaskedPolygons masks_;
  CrowdSampler crowd_;
  std::vector<ScreenTriangle> triangles_;  ///< of the current rows
  PixelCandidates candidates_;
  std::vector<PixelTriangle> here_;  ///< of the current pixel
  std::vector<Layer> layers_;        ///< of the current cell
  PixelRegions regions_;

  PixelRect drawn_;
  std::vector<PixelSum> sum_;
};

}  // namespace

void draw_analytic(const CustomDraw& drawing, const AnalyticOptions& options) {
  const Stopwatch geometry;
  const PolynomialFilter filter(options.filter);
  const Target& target = drawing.target;
  // Vertices of draws that are not kept are transformed when their triangles are set up.
  ProjectedDraws projected = number_draws(drawing.draws, target.viewport, drawing.rules.capacity.screen_vertices);
  project_kept(projected);
  const RasterRules rules{.edge_rule = EdgeRule::Inside, .visibility = drawing.rules.visibility};
  TileTriangles triangles(projected, target, rules, filter.radius());
  drawing.counts.geometry_ms = geometry.ms();
  drawing.counts.triangles = static_cast<std::uint64_t>(projected.first_triangle.back());
  drawing.counts.set_up = triangles.count();

  const Stopwatch tiles;
  Whole whole{drawing, projected, triangles, target, filter, options, std::nullopt};
  if (options.order == FilterOrder::Display) whole.display_light.emplace(drawing.options.display);
  PerThread<TileIntegrator> integrators;
  const auto columns = static_cast<std::size_t>(triangles.columns());
  const double count = static_cast<double>(columns) * triangles.rows();
  std::atomic<int> done = 0;
  for (int row = 0; row < triangles.rows();) {
    const std::size_t first = static_cast<std::size_t>(row) * columns;
    row = triangles.list_rows(row);
    parallel_for(static_cast<std::size_t>(row) * columns - first, [&](std::size_t tile) {
      integrators.local(whole).draw(first + tile);
      if (drawing.options.progress) drawing.options.progress(++done / count);
    });
  }
  integrators.for_each([&](const TileIntegrator& each) { drawing.counts.shaded += each.shaded(); });
  drawing.counts.tiles_ms = tiles.ms();
}

}  // namespace zoneplate::antialias
