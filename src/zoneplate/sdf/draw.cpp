// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/draw.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/sdf/evaluate.h"

namespace zoneplate::sdf {
namespace {

constexpr int block_side = 8, tile_blocks = 8, tile_side = block_side * tile_blocks;
static_assert(block_side * block_side == batch_size && tile_blocks * tile_blocks == batch_size);
constexpr double diagonal = 1.41421356237;
/// In pixels, the greatest distance of a pixel with coverage from the bounds, with a margin for rounding.
constexpr double coverage_reach = diagonal / 2 + 0.01;

/// A range of blocks or tiles, from first to last.
struct Cells {
  int x0, y0, x1, y1;
  bool empty() const { return x0 > x1 || y0 > y1; }
};

/// The cells of this side, in pixels, with pixels whose centre is so near to the bounds that they may have coverage.
Cells cells_of(const Bounds& bounds, const Raster& raster, int side) {
  const auto cell = [side](double pixels, int size) {
    return static_cast<int>(std::clamp(std::floor(pixels / side), -1.0, static_cast<double>((size - 1) / side + 1)));
  };
  constexpr double margin = coverage_reach;
  Cells c{cell((bounds.low.x - raster.origin.x) * raster.scale - margin, raster.width),
          cell((bounds.low.y - raster.origin.y) * raster.scale - margin, raster.height),
          cell((bounds.high.x - raster.origin.x) * raster.scale + margin, raster.width),
          cell((bounds.high.y - raster.origin.y) * raster.scale + margin, raster.height)};
  if (bounds.empty()) return {0, 0, -1, -1};
  return {std::max(c.x0, 0), std::max(c.y0, 0), std::min(c.x1, (raster.width - 1) / side),
          std::min(c.y1, (raster.height - 1) / side)};
}

/// The layers of each tile, in order.
struct TileLists {
  std::vector<std::size_t> first;  ///< of a tile, in `layers`; one more than there are tiles
  std::vector<std::uint32_t> layers;
};

TileLists bin(const Drawing& drawing, const Raster& raster, int columns, int rows) {
  TileLists lists;
  lists.first.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) + 1, 0);
  const auto for_tiles = [&](const Drawing::Layer& layer, const auto& use) {
    const Cells tiles = cells_of(layer.shape.bounds, raster, tile_side);
    for (int y = tiles.y0; y <= tiles.y1; ++y)
      for (int x = tiles.x0; x <= tiles.x1; ++x) use(static_cast<std::size_t>(y * columns + x));
  };
  for (const Drawing::Layer& layer : drawing.layers)
    for_tiles(layer, [&](std::size_t tile) { ++lists.first[tile + 1]; });
  for (std::size_t i = 1; i < lists.first.size(); ++i) lists.first[i] += lists.first[i - 1];
  lists.layers.resize(lists.first.back());
  std::vector<std::size_t> next(lists.first.begin(), lists.first.end() - 1);
  for (std::size_t i = 0; i < drawing.layers.size(); ++i)
    for_tiles(drawing.layers[i], [&](std::size_t tile) { lists.layers[next[tile]++] = static_cast<std::uint32_t>(i); });
  return lists;
}

/// The centres of a block's pixels, moved by a part of a pixel.
void set_points(PointBatch& points, const Raster& raster, int left, int top, double dx, double dy) {
  for (int y = 0; y < block_side; ++y)
    for (int x = 0; x < block_side; ++x) {
      const Point p = raster.centre(left + x + dx, top + y + dy);
      points.x[y * block_side + x] = static_cast<float>(p.x);
      points.y[y * block_side + x] = static_cast<float>(p.y);
    }
}

/// Selects the parts of outlines that matter to the tile with this first pixel.
void select_for_tile(const Program& program, const ShapeCode& shape, const Raster& raster, int left, int top,
                     EvaluationStacks& stacks) {
  constexpr double margin = 1;  // in pixels; the points of a pixel lie within half of one
  Bounds tile;
  tile.add(raster.centre(left - margin, top - margin));
  tile.add(raster.centre(left + tile_side - 1 + margin, top + tile_side - 1 + margin));
  stacks.select_for(program, shape, tile);
}

/// A tile's accumulated colours, block by block.
struct TileBuffer {
  float plane[4][batch_size * batch_size];
};

/// Draws the layers over one tile.
class TilePainter {
 public:
  TilePainter(const Drawing& drawing, const Raster& raster, int grid)
      : drawing_(drawing),
        raster_(raster),
        grid_(grid),
        stacks_(drawing.program),
        kernels_(CoverageKernels::of()),
        buffer_(std::make_unique<TileBuffer>()) {}

  void clear(const Linear& color) {
    const float c[4] = {color.r, color.g, color.b, color.a};
    for (int k = 0; k < 4; ++k) std::fill(std::begin(buffer_->plane[k]), std::end(buffer_->plane[k]), c[k]);
  }

  void paint(const Drawing::Layer& layer, int tile_x, int tile_y) {
    Cells blocks = cells_of(layer.shape.bounds, raster_, block_side);
    const int x0 = tile_x * tile_blocks, y0 = tile_y * tile_blocks;
    blocks = {std::max(blocks.x0, x0), std::max(blocks.y0, y0), std::min(blocks.x1, x0 + tile_blocks - 1),
              std::min(blocks.y1, y0 + tile_blocks - 1)};
    // Above this number of blocks, the distances at their centres, one evaluation, exclude most of them.
    constexpr int many = 6;
    const bool is_large = (blocks.x1 - blocks.x0 + 1) * (blocks.y1 - blocks.y0 + 1) > many;
    select_for_tile(drawing_.program, layer.shape, raster_, x0 * block_side, y0 * block_side, stacks_);
    DistanceBatch centres;
    if (is_large) {
      points_.begin = 0, points_.end = batch_size;
      for (int y = 0; y < tile_blocks; ++y)
        for (int x = 0; x < tile_blocks; ++x) {
          const Point p = raster_.centre((x0 + x + 0.5) * block_side - 0.5, (y0 + y + 0.5) * block_side - 0.5);
          points_.x[y * tile_blocks + x] = static_cast<float>(p.x);
          points_.y[y * tile_blocks + x] = static_cast<float>(p.y);
        }
      kernels_.evaluate(drawing_.program, layer.shape, points_, stacks_);
      centres = stacks_.values[0];
    }
    // The distance of a block's pixels from its centre, half a pixel, and a margin for rounding.
    const auto reach = static_cast<float>((block_side * diagonal / 2 + 0.1) / raster_.scale);
    for (int y = blocks.y0; y <= blocks.y1; ++y)
      for (int x = blocks.x0; x <= blocks.x1; ++x) {
        check_deadline();
        const int block = (y - y0) * tile_blocks + x - x0;
        if (is_large && centres.d[block] > reach) continue;
        // Rows of pixels that the bounds do not reach have no coverage.
        const Rows rows = rows_of(layer.shape.bounds, y * block_side);
        if (rows.first >= rows.end) continue;
        points_.begin = rows.first * block_side, points_.end = rows.end * block_side;
        cover(layer, x * block_side, y * block_side, is_large && centres.d[block] < -reach);
        const float color[4] = {layer.color.r, layer.color.g, layer.color.b, layer.color.a};
        float* planes[4];
        for (int c = 0; c < 4; ++c) planes[c] = buffer_->plane[c] + block * batch_size;
        kernels_.composite(points_, coverage_, color, planes);
      }
  }

  void store(LinearImage& image, int tile_x, int tile_y) const {
    const int left = tile_x * tile_side, top = tile_y * tile_side;
    for (int y = 0; y < tile_side && top + y < image.height(); ++y)
      for (int x = 0; x < tile_side && left + x < image.width(); ++x) {
        const int i =
            (y / block_side * tile_blocks + x / block_side) * batch_size + y % block_side * block_side + x % block_side;
        image(left + x, top + y) = {buffer_->plane[0][i], buffer_->plane[1][i], buffer_->plane[2][i],
                                    buffer_->plane[3][i]};
      }
  }

 private:
  /// The rows of a block that the bounds reach.
  struct Rows {
    int first, end;
  };
  Rows rows_of(const Bounds& bounds, int top) const {
    const auto row = [&](double y) {
      return static_cast<int>(
          std::clamp(std::floor((y - raster_.origin.y) * raster_.scale) - top, -1.0, block_side * 1.0));
    };
    const double reach = coverage_reach / raster_.scale;
    return {std::max(row(bounds.low.y - reach), 0), std::min(row(bounds.high.y + reach), block_side - 1) + 1};
  }

  void cover(const Drawing::Layer& layer, int left, int top, bool is_inside) {
    std::fill(std::begin(coverage_), std::end(coverage_), is_inside ? 1.0f : 0.0f);
    if (is_inside) return;
    const auto inverse_footprint = static_cast<float>(raster_.scale * grid_);
    const float weight = 1.0f / static_cast<float>(grid_ * grid_);
    for (int j = 0; j < grid_; ++j)
      for (int i = 0; i < grid_; ++i) {
        set_points(points_, raster_, left, top, (i + 0.5) / grid_ - 0.5, (j + 0.5) / grid_ - 0.5);
        kernels_.evaluate(drawing_.program, layer.shape, points_, stacks_);
        kernels_.add_coverage(points_, stacks_.values[0], inverse_footprint, weight, coverage_);
      }
  }

  const Drawing& drawing_;
  const Raster& raster_;
  int grid_;
  EvaluationStacks stacks_;
  const CoverageKernels& kernels_;
  std::unique_ptr<TileBuffer> buffer_;
  PointBatch points_;
  alignas(32) float coverage_[batch_size];
};

/// Calls use(left, top, values) for the blocks of a raster.
template <class Use>
void evaluate_blocks(const Program& program, const ShapeCode& code, const Raster& raster, const Use& use) {
  const int columns = (raster.width + tile_side - 1) / tile_side, rows = (raster.height + tile_side - 1) / tile_side;
  PerThread<EvaluationStacks> stacks;
  parallel_for(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), [&](std::size_t tile) {
    EvaluationStacks& own = stacks.local(program);
    PointBatch points;
    const int x = static_cast<int>(tile) % columns * tile_side, y = static_cast<int>(tile) / columns * tile_side;
    select_for_tile(program, code, raster, x, y, own);
    for (int top = y; top < std::min(y + tile_side, raster.height); top += block_side)
      for (int left = x; left < std::min(x + tile_side, raster.width); left += block_side) {
        check_deadline();
        set_points(points, raster, left, top, 0, 0);
        CoverageKernels::of().evaluate(program, code, points, own);
        use(left, top, own.values[0]);
      }
  });
}

}  // namespace

LinearImage draw(const Drawing& drawing, const Raster& raster, const Linear& background, int grid) {
  LinearImage image(raster.width, raster.height, background);
  const int columns = (raster.width + tile_side - 1) / tile_side, rows = (raster.height + tile_side - 1) / tile_side;
  const TileLists lists = bin(drawing, raster, columns, rows);
  PerThread<TilePainter> painters;
  parallel_for(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), [&](std::size_t tile) {
    if (lists.first[tile] == lists.first[tile + 1]) return;
    TilePainter& painter = painters.local(drawing, raster, grid);
    const int x = static_cast<int>(tile) % columns, y = static_cast<int>(tile) / columns;
    painter.clear(background);
    for (std::size_t i = lists.first[tile]; i < lists.first[tile + 1]; ++i)
      painter.paint(drawing.layers[lists.layers[i]], x, y);
    painter.store(image, x, y);
  });
  return image;
}

Plane<float> coverage_of(const ShapePtr& shape, const Raster& raster, int grid) {
  Drawing drawing;
  drawing.fill(shape, {1, 1, 1, 1});
  const LinearImage image = draw(drawing, raster, {0, 0, 0, 0}, grid);
  Plane<float> coverage(raster.width, raster.height);
  std::ranges::transform(image.values(), coverage.values().begin(), &Linear::a);
  return coverage;
}

DistanceField distance_field(const ShapePtr& shape, const Raster& raster) {
  Program program;
  const ShapeCode code = program.add(shape);
  const Plane<float> empty(raster.width, raster.height);
  DistanceField field{empty, empty, empty};
  evaluate_blocks(program, code, raster, [&](int left, int top, const DistanceBatch& values) {
    for (int y = 0; y < block_side && top + y < raster.height; ++y)
      for (int x = 0; x < block_side && left + x < raster.width; ++x) {
        const int i = y * block_side + x;
        field.distance(left + x, top + y) = values.d[i];
        field.gradient_x(left + x, top + y) = values.x[i];
        field.gradient_y(left + x, top + y) = values.y[i];
      }
  });
  return field;
}

std::vector<float> distances_at(const ShapePtr& shape, std::span<const Point> points) {
  Program program;
  const ShapeCode code = program.add(shape);
  EvaluationStacks stacks(program);
  std::vector<float> out;
  PointBatch batch;
  for (std::size_t first = 0; first < points.size(); first += batch_size) {
    for (int i = 0; i < batch_size; ++i) {
      const Point p = points[std::min(first + static_cast<std::size_t>(i), points.size() - 1)];
      batch.x[i] = static_cast<float>(p.x), batch.y[i] = static_cast<float>(p.y);
    }
    CoverageKernels::of().evaluate(program, code, batch, stacks);
    const std::size_t count = std::min<std::size_t>(batch_size, points.size() - first);
    out.insert(out.end(), stacks.values[0].d, stacks.values[0].d + count);
  }
  return out;
}

}  // namespace zoneplate::sdf
