// The exact picture, a tile at a time: candidates of each pixel, its visible polygons, their colours, their sum.
#include "zoneplate/antialias/analytic_draw.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "zoneplate/antialias/analytic_candidates.h"
#include "zoneplate/antialias/analytic_colors.h"
#include "zoneplate/antialias/analytic_fragments.h"
#include "zoneplate/antialias/analytic_regions.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/memory_limit.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/coverage.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t many_triangles = 32768;   // of a tile that is not drawn at once
constexpr std::size_t enough_fragments = 2048;  // that are shaded together

/// What all tiles look at.
struct Whole {
  const Drawing& drawing;
  const ProjectedDraws& projected;
  const TileTriangles& triangles;
  const Target& target;
  const PolynomialFilter& filter;
  const AnalyticOptions& options;
  std::optional<ShownLight> shown;
};

/// The part of a tile that is drawn, and the pixels around that count for it.
PixelRect drawn_rect(const Whole& whole, std::size_t tile) {
  const TileTriangles& t = whole.triangles;
  const Target& target = whole.target;
  const int x = (t.first_column() + static_cast<int>(tile) % t.columns()) * tile_size;
  const int y = (t.first_row() + static_cast<int>(tile) / t.columns()) * tile_size;
  return {std::max(x, target.x), std::max(y, target.y), std::min(x + tile_size, target.x + target.width),
          std::min(y + tile_size, target.y + target.height)};
}

PixelRect rect_around(const PixelRect& r, int reach, Viewport viewport) {
  return {std::max(r.left - reach, 0), std::max(r.top - reach, 0), std::min(r.right + reach, viewport.width),
          std::min(r.bottom + reach, viewport.height)};
}

/// As many texels count for a part of a pixel as lie in it, or in the whole pixel where that is asked for.
Footprints footprints(const Whole& whole) {
  if (!whole.drawing.options.sample_footprint) return {};
  const AnalyticOptions& o = whole.options;
  return {1 / static_cast<float>(o.shading), 1 / static_cast<float>(std::max(o.shading, o.mask))};
}

class TileIntegrator {
 public:
  explicit TileIntegrator(const Whole& whole)
      : whole_(whole),
        list_(whole.filter, whole.options.shading, whole.options.mask),
        colors_(whole.projected, whole.drawing.shader, whole.drawing.rules.isa, whole.target, footprints(whole)) {}

  void draw(std::size_t tile) {
    if (whole_.triangles.of_tile(tile).empty()) return;
    drawn_ = drawn_rect(whole_, tile);
    const PixelRect around = rect_around(drawn_, whole_.filter.reach(), whole_.target.viewport);
    const auto pixels = static_cast<std::size_t>(drawn_.width()) * static_cast<std::size_t>(drawn_.height());
    sum_.assign(pixels, {});
    covered_.assign(pixels, 0);
    const int rows = rows_at_once(whole_.triangles.of_tile(tile).size());
    for (int top = around.top; top < around.bottom; top += rows)
      draw_rows(tile, {around.left, top, around.right, std::min(top + rows, around.bottom)});
    add_fragments();
    write();
  }

  std::uint64_t shaded() const { return colors_.shaded(); }

 private:
  struct Sum {
    double r = 0, g = 0, b = 0, a = 0;
  };

  /// Of a tile with many triangles only a few rows are at work at a time: that bounds what is stored.
  static int rows_at_once(std::size_t triangles) {
    return triangles <= many_triangles ? 2 * tile_size : triangles <= 8 * many_triangles ? 8 : 1;
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
    if (candidates.size() == 1 && candidates[0].covers_pixel && nearest.surface == Surface::Opaque) {
      list_.add_whole(nearest.shape.id, x, y);
    } else {
      here_.clear();
      for (const PixelCandidates::Candidate& c : candidates)
        here_.push_back(at_pixel(triangles_[c.triangle], c.covers_pixel, x, y));
      list_.begin_pixel(x, y);
      regions_.find(here_, [&](const PixelCells& cells) { list_.add(cells); });
    }
    if (list_.fragments().size() >= enough_fragments) add_fragments();
  }

  /// Shades the fragments and adds them to the pixels around.
  void add_fragments() {
    colors_.find(list_);
    for (std::size_t i = 0; i < list_.fragments().size(); ++i) {
      const Fragment& f = list_.fragments()[i];
      if (colors_.is_closed(i) && drawn_.contains(f.x, f.y)) covered_[place_of(f.x, f.y)] += f.moments.area;
      add(i, whole_.shown ? (*whole_.shown)(colors_.color(i)) : colors_.color(i));
    }
    list_.clear();
  }

  void add(std::size_t i, Linear color) {
    const Fragment& f = list_.fragments()[i];
    const int reach = whole_.filter.reach();
    const double* weight = list_.weights_of(i).data();
    for (int y = f.y - reach; y <= f.y + reach; ++y)
      for (int x = f.x - reach; x <= f.x + reach; ++x, ++weight) {
        if (!drawn_.contains(x, y)) continue;
        Sum& s = sum_[place_of(x, y)];
        s = {s.r + *weight * color.r, s.g + *weight * color.g, s.b + *weight * color.b, s.a + *weight * color.a};
      }
  }

  std::size_t place_of(int x, int y) const {
    return static_cast<std::size_t>(y - drawn_.top) * static_cast<std::size_t>(drawn_.width()) +
           static_cast<std::size_t>(x - drawn_.left);
  }

  void write() const {
    const Target& target = whole_.target;
    for (int y = drawn_.top; y < drawn_.bottom; ++y)
      for (int x = drawn_.left; x < drawn_.right; ++x) {
        const Sum& s = sum_[place_of(x, y)];
        const double share = whole_.filter.share_inside(x, target.viewport.width) *
                             whole_.filter.share_inside(y, target.viewport.height);
        const auto mean = [&](double v) { return static_cast<float>(v / share); };
        (*target.color)(x - target.x, y - target.y) = {mean(s.r), mean(s.g), mean(s.b), mean(s.a)};
        if (target.coverage)
          (*target.coverage)(x - target.x, y - target.y) = static_cast<float>(covered_[place_of(x, y)]);
      }
  }

  const Whole& whole_;
  FragmentList list_;
  FragmentColors colors_;
  std::vector<ScreenTriangle> triangles_;  ///< of the rows at work
  PixelCandidates candidates_;
  std::vector<PixelTriangle> here_;  ///< of the pixel at work
  PixelRegions regions_;

  PixelRect drawn_;
  std::vector<Sum> sum_;
  std::vector<double> covered_;  ///< the area that surfaces own
};

}  // namespace

void draw_analytic(const Drawing& drawing, const AnalyticOptions& options) {
  const Stopwatch geometry;
  const PolynomialFilter filter(options.filter);
  const Target& target = drawing.target;
  const ProjectedDraws projected = project_draws(drawing.draws, target.viewport, drawing.rules.isa);
  const SetupRules rules{.viewport = target.viewport, .is_top_left = false, .is_flat_depth = drawing.rules.is_painter};
  TileTriangles triangles(projected, target, rules, filter.reach());
  drawing.counts.geometry_ms = geometry.ms();
  drawing.counts.triangles = static_cast<std::uint64_t>(projected.first_triangle.back());
  drawing.counts.set_up = triangles.count();

  const Stopwatch tiles;
  Whole whole{drawing, projected, triangles, target, filter, options, std::nullopt};
  if (options.order == FilterOrder::Display)
    whole.shown.emplace(drawing.options.display ? *drawing.options.display : DisplayOptions{});
  std::vector<std::unique_ptr<TileIntegrator>> integrators(static_cast<std::size_t>(thread_limit()));
  for (int row = 0; row < triangles.rows();) {
    const auto columns = static_cast<std::size_t>(triangles.columns());
    const std::size_t first = static_cast<std::size_t>(row) * columns;
    row = triangles.list_rows(row);
    parallel_for(static_cast<std::size_t>(row) * columns - first, [&](std::size_t tile) {
      std::unique_ptr<TileIntegrator>& mine = integrators[static_cast<std::size_t>(thread_index())];
      if (!mine) mine = std::make_unique<TileIntegrator>(whole);
      mine->draw(first + tile);
    });
  }
  for (const auto& integrator : integrators)
    if (integrator) drawing.counts.shaded += integrator->shaded();
  drawing.counts.tiles_ms = tiles.ms();
}

}  // namespace zoneplate::antialias
