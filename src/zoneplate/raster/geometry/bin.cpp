// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/bin.h"

#include <algorithm>
#include <new>
#include <utility>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/geometry/clip_fan.h"
#include "zoneplate/raster/types/tile_grid.h"

namespace zoneplate {
namespace {

/// The size, in 1/256 pixel, up to which a triangle's samples are cheaper to list than the triangle: some 16 samples.
std::int32_t small_extent(int samples) {
  if (samples > 16) return -1;
  return samples > 8 ? 511 : samples > 4 ? 723 : samples > 2 ? 1023 : samples > 1 ? 1447 : 2047;
}

/// The bounds of three vertices, 1/256 pixel from the image's top-left corner.
struct Extent {
  std::int32_t low_x, high_x, low_y, high_y;
};

/// The work of one thread on a run of triangles of one draw.
class Binner {
 public:
  Binner(const ProjectedDraws& projected, const Target& target, const RasterRules& rules, Bins& bins)
      : projected_(projected),
        target_(target),
        rules_(rules),
        bins_(bins),
        worker_(bins.workers[static_cast<std::size_t>(thread_index())]) {}

  void add(std::size_t d, std::int32_t begin, std::int32_t end, const SampleArrays& samples,
           const SmallTriangleKernels& kernels) {
    const Draw& draw = projected_.draws[d];
    SmallTriangleRun run = run_of(d, samples);
    SampleBinWriter sink{.first_column = bins_.first_column,
                         .first_row = bins_.first_row,
                         .columns = bins_.columns,
                         .last = worker_.fragments.last(),
                         .owner = &worker_,
                         .grow = grow};
    SmallTriangleResult result;
    for (std::int32_t first = begin; first < end; first += SmallTriangleRun::capacity) {
      run.index = draw.index.data() + 3 * static_cast<std::size_t>(first - projected_.first_triangle[d]);
      run.first_id = first;
      run.count = std::min(SmallTriangleRun::capacity, end - first);
      run.records = is_painter() ? nullptr : worker_.triangles.reserve(SmallTriangleRun::capacity, worker_.arena);
      kernels.run(run, sink, result);
      worker_.drawn += result.drawn;
      for (std::int32_t i = 0; i < result.visible_count; ++i)
        if (run.records)
          list_in_tiles(draw, run.records[i], worker_.triangles.add(1));
        else
          add_kept(d, first + result.visible[i]);
      for (std::int32_t i = 0; i < result.deferred_count; ++i) add_general(d, first + result.deferred[i]);
    }
  }

 private:
  bool is_painter() const { return rules_.visibility == Visibility::Painter; }

  /// The parameters that all runs of a draw share.
  SmallTriangleRun run_of(std::size_t d, const SampleArrays& samples) const {
    const Draw& draw = projected_.draws[d];
    const bool draws_fragments = draw.alpha_mode == AlphaMode::Opaque && !is_painter();
    SmallTriangleRun run{};
    run.screen = projected_.screen[d].data();
    run.viewport = target_.viewport;
    run.left = target_.x, run.right = target_.x + target_.width - 1;
    run.top = target_.y, run.bottom = target_.y + target_.height - 1;
    run.sample_x = samples.x.data(), run.sample_y = samples.y.data();
    run.sample_count = static_cast<std::int32_t>(samples.x.size());
    run.facing = !draw.culls_back_faces ? 0 : draw.is_mirrored ? 1 : -1;
    run.edge_rule = rules_.edge_rule;
    run.small_extent = draws_fragments ? small_extent(run.sample_count) : -1;
    return run;
  }

  Extent extent_of(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) const {
    const std::int32_t cx = target_.viewport.width * 128, cy = target_.viewport.height * 128;
    return {std::min({p.x, q.x, r.x}) + cx, std::max({p.x, q.x, r.x}) + cx, std::min({p.y, q.y, r.y}) + cy,
            std::max({p.y, q.y, r.y}) + cy};
  }

  /// True if some sample of the pattern lies within the bounds of the three vertices.
  bool may_cover_a_sample(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) const {
    const Extent e = extent_of(p, q, r);
    return std::any_of(target_.samples.begin(), target_.samples.end(), [&](SamplePosition s) {
      return (e.low_x - s.x + 255) >> 8 <= (e.high_x - s.x) >> 8 && (e.low_y - s.y + 255) >> 8 <= (e.high_y - s.y) >> 8;
    });
  }

  static SampleBin* grow(SampleBinWriter& sink, std::int32_t tile, std::int32_t first_id) {
    auto& worker = *static_cast<Bins::Worker*>(sink.owner);
    return worker.fragments.grow(static_cast<std::size_t>(tile), first_id, worker.arena);
  }

  const std::uint32_t* corners(std::size_t d, std::int32_t triangle) const {
    return &projected_.draws[d].index[3 * static_cast<std::size_t>(triangle - projected_.first_triangle[d])];
  }

  void add_kept(std::size_t d, std::int32_t triangle) {
    const std::uint32_t* v = corners(d, triangle);
    const auto& screen = projected_.screen[d];
    emit(projected_.draws[d], screen[v[0]], screen[v[1]], screen[v[2]], triangle);
  }

  void add_general(std::size_t d, std::int32_t triangle) {
    const Draw& draw = projected_.draws[d];
    const std::uint32_t* v = corners(d, triangle);
    const auto& screen = projected_.screen[d];
    const ScreenVertex &p = screen[v[0]], &q = screen[v[1]], &r = screen[v[2]];
    if (p.needs_clipping() || q.needs_clipping() || r.needs_clipping()) return add_clipped(d, triangle, v);
    const std::int64_t area = doubled_area(p, q, r);
    if (area == 0 || is_culled(draw, area > 0) || !may_cover_a_sample(p, q, r)) return;
    emit(draw, p, q, r, triangle);
  }

  void add_clipped(std::size_t d, std::int32_t triangle, const std::uint32_t* v) {
    const Draw& draw = projected_.draws[d];
    for_clipped_triangles(projected_, d, triangle, v, target_.viewport,
                          [&](const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
                            if (may_cover_a_sample(p, q, r)) emit(draw, p, q, r, triangle);
                          });
  }

  void emit(const Draw& draw, const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, std::int32_t id) {
    // Constructed in place: copying a record that was just written in parts stalls the processor.
    const Triangle& t = *::new (worker_.triangles.reserve(1, worker_.arena))
                            Triangle(make_triangle(p, q, r, id, target_.viewport, rules_));
    if (t.min_x > target_.x + target_.width - 1 || t.max_x < target_.x || t.min_y > target_.y + target_.height - 1 ||
        t.max_y < target_.y)
      return;
    list_in_tiles(draw, t, worker_.triangles.add(1));
  }

  void list_in_tiles(const Draw& draw, const Triangle& t, std::size_t place) {
    const auto number = static_cast<std::uint32_t>(place);
    const int first_column = std::max(t.min_x, target_.x) / tile_size;
    const int last_column = std::min(t.max_x, target_.x + target_.width - 1) / tile_size;
    const int first_row = std::max(t.min_y, target_.y) / tile_size;
    const int last_row = std::min(t.max_y, target_.y + target_.height - 1) / tile_size;
    if (first_column == last_column && first_row == last_row)
      return tile_list(draw, first_column, first_row).push_back(number, worker_.arena);
    for (int row = first_row; row <= last_row; ++row)
      for (int column = first_column; column <= last_column; ++column)
        if (touches(t, column * tile_size, row * tile_size))
          tile_list(draw, column, row).push_back(number, worker_.arena);
  }

  /// False if an edge has the whole tile, corner to corner, on its outer side.
  static bool touches(const Triangle& t, int x, int y) {
    constexpr std::int64_t reach = tile_size * 256 - 1;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t a = t.a[k], b = t.b[k];
      const std::int64_t greatest = a * (x * 256) + b * (y * 256) + t.c[k] + std::max<std::int64_t>(a, 0) * reach +
                                    std::max<std::int64_t>(b, 0) * reach;
      if (greatest < 0) return false;
    }
    return true;
  }

  Bins::TileList& tile_list(const Draw& draw, int column, int row) {
    const int tile = (row - bins_.first_row) * bins_.columns + column - bins_.first_column;
    return worker_.tiles[static_cast<std::size_t>(tile)][static_cast<std::size_t>(draw.alpha_mode)];
  }

  const ProjectedDraws& projected_;
  const Target& target_;
  const RasterRules& rules_;
  const Bins& bins_;
  Bins::Worker& worker_;
};

}  // namespace

void Bins::Worker::clear(std::size_t tile_count, const Target& target) {
  arena.clear();
  triangles.clear();
  drawn = 0;
  for (std::array<TileList, 3>& lists : tiles)
    for (TileList& list : lists) list.clear();
  tiles.resize(tile_count);
  fragments.clear(tile_count, static_cast<int>(target.samples.size()), target.keeps_hidden);
}

Bins make_bins(const Target& target, Bins reused) {
  Bins bins = std::move(reused);
  bins.set_up = 0;
  bins.first_column = target.x / tile_size;
  bins.first_row = target.y / tile_size;
  bins.columns = (target.x + target.width - 1) / tile_size - bins.first_column + 1;
  bins.rows = (target.y + target.height - 1) / tile_size - bins.first_row + 1;
  bins.workers.resize(static_cast<std::size_t>(thread_limit()));
  for (Bins::Worker& w : bins.workers) w.clear(bins.tiles(), target);
  return bins;
}

void add_to_bins(const ProjectedDraws& projected, std::size_t first, std::size_t last, const Target& target,
                 const RasterRules& rules, Bins& bins) {
  struct Part {
    std::size_t draw;
    std::int32_t begin, end;
  };
  // Some 64 parts, whole vectors: a few large triangles are in many tiles each.
  const std::int32_t triangles = projected.first_triangle[last] - projected.first_triangle[first];
  const std::int32_t part_size = std::clamp(triangles / 64 & ~15, 16, 1024);
  std::vector<Part> parts;
  for (std::size_t d = first; d < last; ++d) {
    if (projected.draws[d].elsewhere > 0) continue;
    const std::int32_t end = projected.first_triangle[d + 1];
    for (std::int32_t t = projected.first_triangle[d]; t < end; t += std::min(part_size, end - t))
      parts.push_back({d, t, t + std::min(part_size, end - t)});
  }
  const SampleArrays samples(target.samples);
  const SmallTriangleKernels& kernels = SmallTriangleKernels::of();
  parallel_for(parts.size(), [&](std::size_t i) {
    Binner binner(projected, target, rules, bins);
    growing("triangle bins", [&] { binner.add(parts[i].draw, parts[i].begin, parts[i].end, samples, kernels); });
  });
  bins.set_up = 0;
  for (const Bins::Worker& w : bins.workers) bins.set_up += w.triangles.size() + w.drawn;
}

Bins bin_triangles(const ProjectedDraws& projected, const Target& target, const RasterRules& rules, Bins reused) {
  Bins bins = make_bins(target, std::move(reused));
  add_to_bins(projected, 0, projected.draws.size(), target, rules, bins);
  return bins;
}

}  // namespace zoneplate
