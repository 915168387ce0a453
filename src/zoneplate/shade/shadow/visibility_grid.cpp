// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/visibility_grid.h"

#include <algorithm>
#include <cassert>
#include <memory>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr int width = GridNeighbours::width;
/// Cells along a side of a block.
constexpr int block_side = 16;
/// The variance of the mean of evenly distributed rays, relative to that of as many independent ones.
constexpr float evenness = 0.3f;

/// Rounds down.
int quotient(int a, int b) { return a / b - (a % b < 0); }

}  // namespace

/// Threads that evaluate a point at the same time store the same bits.
struct VisibilityGrid::Point {
  std::atomic<bool> is_known = false;
  std::array<std::atomic<std::int32_t>, 2> pixel;
  std::atomic<float> visible = Value::nothing;
  std::array<std::atomic<float>, 3> position, normal;
  std::atomic<float> bend;
  std::atomic<std::uint32_t> surface;

  void store(const Value& v, PixelPosition at) {
    pixel[0].store(at.x, std::memory_order_relaxed), pixel[1].store(at.y, std::memory_order_relaxed);
    const auto put = [](std::array<std::atomic<float>, 3>& to, float3 from) {
      to[0].store(from.x, std::memory_order_relaxed);
      to[1].store(from.y, std::memory_order_relaxed);
      to[2].store(from.z, std::memory_order_relaxed);
    };
    put(position, v.position), put(normal, v.normal);
    bend.store(v.bend, std::memory_order_relaxed);
    surface.store(v.surface, std::memory_order_relaxed);
    visible.store(v.visible, std::memory_order_relaxed);
    is_known.store(true, std::memory_order_release);
  }
};

struct VisibilityGrid::Block {
  std::vector<Point> points;
};

VisibilityGrid::VisibilityGrid(int step, int w, int h, int rays)
    : step_(step),
      rise_(step > 1 ? 1 : 0),
      per_cell_(step > 2 ? GridNeighbours::max_per_cell : 1),
      density_{evenness / static_cast<float>(rays), step > 1},
      kernels_(GridFitKernels::of()) {
  const int det = step * step + rise_;
  // Those about the cells of positions in the image, which are half a pixel beyond the outer pixels' centres.
  first_i_ = -2, first_j_ = quotient(-w - step, det) - 1;
  const int last_i = (step * w + h) / det + width, last_j = step * h / det + width;
  row_ = (last_i - first_i_) / block_side + 1;
  growing("sharing of visibility", [&] {
    blocks_ = std::vector<std::atomic<Block*>>(static_cast<std::size_t>(row_) *
                                               static_cast<std::size_t>((last_j - first_j_) / block_side + 1));
  });
}

VisibilityGrid::~VisibilityGrid() {
  for (const std::atomic<Block*>& block : blocks_) delete block.load();
}

std::uint64_t VisibilityGrid::order_of(int i, int j, int k) const {
  const auto column = static_cast<std::uint64_t>(i - first_i_), row = static_cast<std::uint64_t>(j - first_j_);
  return ((row << 32 | column) << order_bits) + static_cast<std::uint64_t>(k);
}

VisibilityGrid::Cell VisibilityGrid::cell_of(const Receivers& receivers, int k) const {
  constexpr int unit = 256;
  const int x = receivers.x[k] - unit / 2, y = receivers.y[k] - unit / 2, whole = unit * (step_ * step_ + rise_);
  const int along = step_ * x + rise_ * y, down = step_ * y - rise_ * x;
  const int i = quotient(along, whole), j = quotient(down, whole);
  const float scale = 1 / static_cast<float>(whole);
  return {i, j, static_cast<float>(along - i * whole) * scale, static_cast<float>(down - j * whole) * scale, k};
}

PixelPosition VisibilityGrid::pixel_of(int i, int j, int n) const {
  // A place in [0, step) along both axes: x in its own part of them.
  const auto place = [&](int from, int to, int axis) {
    const std::uint32_t random =
        hash(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(2 * n + axis));
    return from + static_cast<int>(random % static_cast<std::uint32_t>(to - from));
  };
  return {step_ * i - rise_ * j + place(step_ * n / per_cell_, step_ * (n + 1) / per_cell_, 0) - step_ / 2,
          rise_ * i + step_ * j + place(0, step_, 1) - step_ / 2};
}

/// The first thread that needs a block makes it.
VisibilityGrid::Point& VisibilityGrid::point(int i, int j, int n) {
  const auto column = static_cast<unsigned>(i - first_i_), row = static_cast<unsigned>(j - first_j_);
  assert(i >= first_i_ && j >= first_j_ && static_cast<int>(column / block_side) < row_);
  std::atomic<Block*>& block =
      blocks_[std::size_t{row / block_side} * static_cast<std::size_t>(row_) + column / block_side];
  Block* found = block.load(std::memory_order_acquire);
  if (found == nullptr) {
    auto made = growing("sharing of visibility", [&] {
      return std::make_unique<Block>(Block{std::vector<Point>(std::size_t{block_side} * block_side * per_cell())});
    });
    if (block.compare_exchange_strong(found, made.get(), std::memory_order_acq_rel)) found = made.release();
  }
  return found->points[(row % block_side * block_side + column % block_side) * per_cell() + static_cast<unsigned>(n)];
}

/// The cells are in order.
void VisibilityGrid::evaluate_missing(std::span<const Cell> cells, const Evaluate& evaluate) {
  struct Missing {
    std::uint64_t order;
    int i, j, n;
    Point* point;
  };
  std::vector<Missing> missing;
  Cell last{first_i_ - width, first_j_ - width, 0, 0, 0};
  for (const Cell& cell : cells) {
    if (cell.is_that_of(last)) continue;
    const auto was_seen = [&](int i, int j) {
      return static_cast<unsigned>(i - last.i + 1) < width && static_cast<unsigned>(j - last.j + 1) < width;
    };
    for (int j = cell.j - 1; j < cell.j - 1 + width; ++j)
      for (int i = cell.i - 1; i < cell.i - 1 + width; ++i)
        for (int n = 0; n < per_cell_ && !was_seen(i, j); ++n)
          if (Point& p = point(i, j, n); !p.is_known.load(std::memory_order_acquire))
            missing.push_back({order_of(i, j, n), i, j, n, &p});
    last = cell;
  }
  std::sort(missing.begin(), missing.end(), [](const Missing& a, const Missing& b) { return a.order < b.order; });
  missing.erase(std::unique(missing.begin(), missing.end(),
                            [](const Missing& a, const Missing& b) { return a.point == b.point; }),
                missing.end());

  std::array<PixelPosition, FragmentBatch::capacity> pixels;
  std::array<Value, FragmentBatch::capacity> values;
  for (std::size_t first = 0; first < missing.size(); first += pixels.size()) {
    const std::size_t count = std::min(pixels.size(), missing.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const Missing& m = missing[first + k];
      pixels[k] = pixel_of(m.i, m.j, m.n);
    }
    evaluate({pixels.data(), count}, values.data());
    for (std::size_t k = 0; k < count; ++k) missing[first + k].point->store(values[k], pixels[k]);
  }
}

GridNeighbours VisibilityGrid::neighbours_of(const Cell& cell) {
  GridNeighbours out;
  const float scale = 1 / static_cast<float>(step_ * step_ + rise_);
  int& k = out.count;
  for (int j = cell.j - 1; j < cell.j - 1 + width; ++j)
    for (int i = cell.i - 1; i < cell.i - 1 + width; ++i)
      for (int n = 0; n < per_cell_; ++n, ++k) {
        const Point& p = point(i, j, n);
        const int x = p.pixel[0].load(std::memory_order_relaxed), y = p.pixel[1].load(std::memory_order_relaxed);
        out.x[k] = static_cast<float>(step_ * x + rise_ * y) * scale - static_cast<float>(cell.i);
        out.y[k] = static_cast<float>(step_ * y - rise_ * x) * scale - static_cast<float>(cell.j);
        out.surface[k] = static_cast<std::int32_t>(p.surface.load(std::memory_order_relaxed));
        for (std::size_t c = 0; c < 3; ++c) {
          out.position[c][k] = p.position[c].load(std::memory_order_relaxed);
          out.normal[c][k] = p.normal[c].load(std::memory_order_relaxed);
        }
        out.bend[k] = p.bend.load(std::memory_order_relaxed);
        out.visible[k] = p.visible.load(std::memory_order_relaxed);
      }
  return out;
}

/// Receivers of one cell have the same neighbours.
void VisibilityGrid::interpolate(const Receivers& receivers, std::span<const int> which, const Evaluate& evaluate,
                                 float* visible) {
  std::array<Cell, Receivers::capacity> places, sorted;
  std::array<std::uint64_t, Receivers::capacity> order;
  static_assert(Receivers::capacity <= 1 << order_bits);
  for (std::size_t k = 0; k < which.size(); ++k) {
    places[k] = cell_of(receivers, which[k]);
    places[k].receiver = static_cast<int>(k);
    order[k] = order_of(places[k].i, places[k].j, places[k].receiver);
  }
  std::sort(order.begin(), order.begin() + which.size());
  for (std::size_t k = 0; k < which.size(); ++k) sorted[k] = places[order[k] % (1 << order_bits)];
  const std::span<const Cell> cells{sorted.data(), which.size()};
  evaluate_missing(cells, evaluate);

  GridReceivers of_cell{};
  for (std::size_t first = 0, end; first < cells.size(); first = end) {
    for (end = first + 1; end < cells.size() && cells[end].is_that_of(cells[first]);) ++end;
    const GridNeighbours near = neighbours_of(cells[first]);
    const std::span<const Cell> same = cells.subspan(first, end - first);
    const bool is_even =
        std::all_of(near.visible, near.visible + near.count, [&](float v) { return v == near.visible[0]; });
    if (receivers.is_ground && is_even && near.visible[0] >= 0) {
      for (const Cell& cell : same) visible[cell.receiver] = near.visible[0];
      continue;
    }
    of_cell.count = static_cast<int>(same.size());
    for (std::size_t n = 0; n < same.size(); ++n) {
      const int k = which[static_cast<std::size_t>(same[n].receiver)];
      of_cell.u[n] = same[n].u, of_cell.v[n] = same[n].v;
      for (std::size_t c = 0; c < 3; ++c)
        of_cell.position[c][n] = receivers.position[c][k], of_cell.normal[c][n] = receivers.normal[c][k];
      of_cell.bend[n] = bend_of(receivers, k);
      of_cell.surface[n] = static_cast<std::int32_t>(receivers.surface[k]);
    }
    float fitted[GridReceivers::capacity];
    kernels_.fit(near, of_cell, density_, fitted);
    for (std::size_t n = 0; n < same.size(); ++n) visible[same[n].receiver] = fitted[n];
  }
}

}  // namespace zoneplate
