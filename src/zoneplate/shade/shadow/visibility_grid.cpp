// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/visibility_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr int width = GridNeighbours::width;
/// Cells along a side of a block.
constexpr int block_side = 16;
/// The variance of the mean of n evenly distributed rays past edges of occluders, relative to that of independent ones,
/// times the square root of n: Mitchell, Consequences of Stratified Sampling in Graphics, SIGGRAPH 1996.
constexpr float evenness = 2.4f;

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
      density_{evenness / (static_cast<float>(rays) * std::sqrt(static_cast<float>(rays))), step > 1},
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

/// The block that contains a cell, which is counted from the first one. The first thread that needs a block makes it.
VisibilityGrid::Block& VisibilityGrid::block_of(unsigned column, unsigned row) {
  std::atomic<Block*>& block =
      blocks_[std::size_t{row / block_side} * static_cast<std::size_t>(row_) + column / block_side];
  Block* found = block.load(std::memory_order_acquire);
  if (found != nullptr) return *found;
  auto made = growing("sharing of visibility", [&] {
    return std::make_unique<Block>(Block{std::vector<Point>(std::size_t{block_side} * block_side * per_cell())});
  });
  if (block.compare_exchange_strong(found, made.get(), std::memory_order_acq_rel)) found = made.release();
  return *found;
}

/// use(point, i, j, n) for the pixels of the window's cells, row by row.
template <class Use>
void VisibilityGrid::for_points(const Window& window, const Use& use) {
  assert(window.i >= first_i_ && window.j >= first_j_);
  for (int j = window.j; j < window.j + window.rows; ++j) {
    const auto row = static_cast<unsigned>(j - first_j_);
    Point* of_row = nullptr;
    for (int i = window.i; i < window.i + window.columns; ++i) {
      const auto column = static_cast<unsigned>(i - first_i_);
      assert(static_cast<int>(column / block_side) < row_);
      if (of_row == nullptr || column % block_side == 0)
        of_row = block_of(column, row).points.data() + std::size_t{row % block_side} * block_side * per_cell();
      for (int n = 0; n < per_cell_; ++n)
        use(of_row[column % block_side * per_cell() + static_cast<unsigned>(n)], i, j, n);
    }
  }
}

/// The receivers of the same cell as the first one. Where all lie at the pixels' centres, as fragments that cover their
/// pixels do in the grid of all pixels, the last row and column have no weight.
VisibilityGrid::Group VisibilityGrid::group_at(std::span<const Cell> cells, std::size_t first) const {
  Group out{first, first, {cells[first].i - 1, cells[first].j - 1, width, width}};
  bool is_centred = step_ == 1;
  for (; out.end < cells.size() && cells[out.end].is_that_of(cells[first]); ++out.end)
    is_centred = is_centred && cells[out.end].u == 0 && cells[out.end].v == 0;
  if (is_centred) out.window.columns = out.window.rows = width - 1;
  return out;
}

void VisibilityGrid::evaluate_missing(std::span<const Group> groups, const Evaluate& evaluate) {
  struct Missing {
    std::uint64_t order;
    int i, j, n;
    Point* point;
  };
  std::vector<Missing> missing;
  Window last{0, 0, 0, 0};
  for (const Group& group : groups) {
    for_points(group.window, [&](Point& p, int i, int j, int n) {
      if (!last.contains(i, j) && !p.is_known.load(std::memory_order_acquire))
        missing.push_back({order_of(i, j, n), i, j, n, &p});
    });
    last = group.window;
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

/// The value that all pixels of the window have.
std::optional<float> VisibilityGrid::even_value(const Window& window) {
  float least = HUGE_VALF, greatest = -HUGE_VALF;
  for_points(window, [&](const Point& p, int, int, int) {
    const float v = p.visible.load(std::memory_order_relaxed);
    least = std::min(least, v), greatest = std::max(greatest, v);
  });
  return least == greatest ? std::optional(least) : std::nullopt;
}

GridNeighbours VisibilityGrid::neighbours_of(const Window& window, const Cell& cell) {
  GridNeighbours out;
  const float scale = 1 / static_cast<float>(step_ * step_ + rise_);
  int& k = out.count;
  for_points(window, [&](const Point& p, int, int, int) {
    const int x = p.pixel[0].load(std::memory_order_relaxed), y = p.pixel[1].load(std::memory_order_relaxed);
    out.x[k] = static_cast<float>(step_ * x + rise_ * y) * scale - static_cast<float>(cell.i);
    out.y[k] = static_cast<float>(step_ * y - rise_ * x) * scale - static_cast<float>(cell.j);
    out.surface[k] = static_cast<std::int32_t>(p.surface.load(std::memory_order_relaxed));
    for (std::size_t c = 0; c < 3; ++c) {
      out.position[c][k] = p.position[c].load(std::memory_order_relaxed);
      out.normal[c][k] = p.normal[c].load(std::memory_order_relaxed);
    }
    out.bend[k] = p.bend.load(std::memory_order_relaxed);
    out.visible[k++] = p.visible.load(std::memory_order_relaxed);
  });
  return out;
}

/// Receivers of one cell have the same neighbours.
void VisibilityGrid::interpolate(const Receivers& receivers, std::span<const int> which, const Evaluate& evaluate,
                                 float* visible) {
  // Receivers in succession mostly lie in one cell: runs of these are sorted.
  std::array<Cell, Receivers::capacity> places, sorted;
  std::array<std::uint64_t, Receivers::capacity> order;
  static_assert(Receivers::capacity <= 1 << order_bits);
  std::size_t runs = 0, end = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    places[k] = cell_of(receivers, which[k]);
    places[k].receiver = static_cast<int>(k);
    if (k == 0 || !places[k].is_that_of(places[k - 1]))
      order[runs++] = order_of(places[k].i, places[k].j, places[k].receiver);
  }
  std::sort(order.begin(), order.begin() + runs);
  for (std::size_t n = 0; n < runs; ++n)
    for (std::size_t first = order[n] % (1 << order_bits), k = first;
         k < which.size() && places[k].is_that_of(places[first]); ++k)
      sorted[end++] = places[k];
  const std::span<const Cell> cells{sorted.data(), which.size()};
  std::array<Group, Receivers::capacity> groups;
  std::size_t count = 0;
  for (std::size_t first = 0; first < cells.size(); first = groups[count++].end) groups[count] = group_at(cells, first);
  evaluate_missing({groups.data(), count}, evaluate);

  GridReceivers of_cell{};
  for (const Group& group : std::span(groups.data(), count)) {
    const std::span<const Cell> same = cells.subspan(group.first, group.end - group.first);
    if (receivers.is_ground)
      if (const std::optional<float> even = even_value(group.window); even && *even >= 0) {
        for (const Cell& cell : same) visible[cell.receiver] = *even;
        continue;
      }
    const GridNeighbours near = neighbours_of(group.window, same[0]);
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
