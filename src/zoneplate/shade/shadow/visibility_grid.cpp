// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/visibility_grid.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "zoneplate/base/out_of_memory.h"

namespace zoneplate {
namespace {

/// Points of a cell's neighbourhood along one axis, of which the second is the cell's own.
constexpr int width = 4;
/// Points along a side of a block.
constexpr int block_side = 16;

/// Of the normals of points of one surface.
constexpr float least_cosine = 0.98f;
/// The greatest cosine of half the sum of two normals with the line between their points.
constexpr float greatest_slope = 0.15f;
/// The least sum of the weights of the points on the surface; that of all is 1.
constexpr float least_weight = 0.3f;
/// The fewest such points.
constexpr int least_points = 6;
/// The greatest standard deviation of values from the fitted plane, besides their error.
constexpr float greatest_deviation = 0.03f;
/// The variance of the mean of evenly distributed rays, relative to that of as many independent ones.
constexpr float evenness = 0.3f;
/// Weight of a plane without slope, relative to that of the points: where these lie on a line, it decides across.
constexpr float flatness = 0.02f;

/// Rounds down.
int quotient(int a, int b) { return a / b - (a % b < 0); }

/// The cubic B-spline at the points -1, 0, 1 and 2 from a place t after point 0.
std::array<float, width> spline(float t) {
  const float s = 1 - t;
  constexpr float sixth = 1 / 6.0f;
  return {s * s * s * sixth, (4 - 6 * t * t + 3 * t * t * t) * sixth, (4 - 6 * s * s + 3 * s * s * s) * sixth,
          t * t * t * sixth};
}

/// Points about a cell.
constexpr std::size_t neighbours = std::size_t{width} * width;
using OfNeighbours = std::array<float, neighbours>;

/// Weighted moments of places (x, y) and values.
struct Moments {
  float one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, f = 0, xf = 0, yf = 0, ff = 0;

  Moments(const OfNeighbours& weight, const OfNeighbours& value, float u, float v) {
    for (int b = 0; b < width; ++b) {
      // The sums of a row, in which y is constant.
      float row_one = 0, row_x = 0, row_xx = 0, row_f = 0, row_xf = 0;
      const float py = static_cast<float>(b - 1) - v;
      for (int a = 0; a < width; ++a) {
        const auto k = static_cast<std::size_t>(b * width + a);
        const float px = static_cast<float>(a - 1) - u, wx = weight[k] * px, wf = weight[k] * value[k];
        row_one += weight[k], row_x += wx, row_xx += wx * px;
        row_f += wf, row_xf += wx * value[k], ff += wf * value[k];
      }
      one += row_one, x += row_x, xx += row_xx, f += row_f, xf += row_xf;
      y += row_one * py, xy += row_x * py, yy += row_one * py * py, yf += row_f * py;
    }
  }
};

/// The plane that fits the values best.
struct FittedPlane {
  float at_origin;
  float variance;  ///< of the values about it
};
FittedPlane fit(const Moments& m) {
  const float mx = m.x / m.one, my = m.y / m.one, mf = m.f / m.one;
  const float xx = m.xx / m.one - mx * mx + flatness, yy = m.yy / m.one - my * my + flatness,
              xy = m.xy / m.one - mx * my;
  const float xf = m.xf / m.one - mx * mf, yf = m.yf / m.one - my * mf, ff = m.ff / m.one - mf * mf;
  const float determinant = xx * yy - xy * xy;
  const float along = (xf * yy - yf * xy) / determinant, down = (yf * xx - xf * xy) / determinant;
  return {mf - along * mx - down * my, std::max(0.0f, ff - along * xf - down * yf)};
}

}  // namespace

/// Threads that evaluate a point at the same time store the same bits.
struct VisibilityGrid::Point {
  std::atomic<bool> is_known = false;
  std::atomic<float> visible = Value::nothing;
  std::array<std::atomic<float>, 3> position, normal;

  void store(const Value& v) {
    const auto put = [](std::array<std::atomic<float>, 3>& to, float3 from) {
      to[0].store(from.x, std::memory_order_relaxed);
      to[1].store(from.y, std::memory_order_relaxed);
      to[2].store(from.z, std::memory_order_relaxed);
    };
    put(position, v.position), put(normal, v.normal);
    visible.store(v.visible, std::memory_order_relaxed);
    is_known.store(true, std::memory_order_release);
  }
};

struct VisibilityGrid::Block {
  std::array<Point, std::size_t{block_side} * block_side> points;
};

/// The points about a cell: by coordinate, then by row and column.
struct VisibilityGrid::Neighbours {
  std::array<OfNeighbours, 3> position, normal;
  OfNeighbours visible;
  bool is_even = true;  ///< all have the same value
};

VisibilityGrid::VisibilityGrid(int step, int w, int h, int rays)
    : step_(step), noise_(evenness / static_cast<float>(rays)) {
  const int det = step * step + 1;
  // Point (i, j) is the pixel (step i - j, i + step j).
  first_i_ = -1, first_j_ = quotient(-w, det) - 1;
  const int last_i = (step * w + h) / det + width, last_j = step * h / det + width;
  row_ = (last_i - first_i_) / block_side + 1;
  growing("shared visibility", [&] {
    blocks_ = std::vector<std::atomic<Block*>>(static_cast<std::size_t>(row_) *
                                               static_cast<std::size_t>((last_j - first_j_) / block_side + 1));
  });
}

VisibilityGrid::~VisibilityGrid() {
  for (const std::atomic<Block*>& block : blocks_) delete block.load();
}

VisibilityGrid::Cell VisibilityGrid::cell_of(const Receivers& receivers, int k) const {
  constexpr int unit = 256;
  const int x = receivers.x[k] - unit / 2, y = receivers.y[k] - unit / 2, whole = unit * (step_ * step_ + 1);
  const int along = step_ * x + y, down = step_ * y - x;
  const int i = quotient(along, whole), j = quotient(down, whole);
  const float scale = 1 / static_cast<float>(whole);
  return {i, j, static_cast<float>(along - i * whole) * scale, static_cast<float>(down - j * whole) * scale};
}

/// The first thread that needs a block makes it.
VisibilityGrid::Point& VisibilityGrid::point(int i, int j) {
  const auto column = static_cast<unsigned>(i - first_i_), row = static_cast<unsigned>(j - first_j_);
  assert(i >= first_i_ && j >= first_j_ && static_cast<int>(column / block_side) < row_);
  std::atomic<Block*>& block =
      blocks_[std::size_t{row / block_side} * static_cast<std::size_t>(row_) + column / block_side];
  Block* found = block.load(std::memory_order_acquire);
  if (found == nullptr) {
    auto made = growing("shared visibility", [] { return std::make_unique<Block>(); });
    if (block.compare_exchange_strong(found, made.get(), std::memory_order_acq_rel)) found = made.release();
  }
  return found->points[row % block_side * block_side + column % block_side];
}

void VisibilityGrid::evaluate_missing(const Receivers& receivers, std::span<const int> which,
                                      const Evaluate& evaluate) {
  std::vector<std::pair<int, int>> missing;  // (j, i)
  Cell last{first_i_ - width, first_j_ - width, 0, 0};
  for (const int k : which) {
    const Cell cell = cell_of(receivers, k);
    if (cell.is_that_of(last)) continue;
    const auto was_seen = [&](int i, int j) {
      return static_cast<unsigned>(i - last.i + 1) < width && static_cast<unsigned>(j - last.j + 1) < width;
    };
    for (int j = cell.j - 1; j < cell.j - 1 + width; ++j)
      for (int i = cell.i - 1; i < cell.i - 1 + width; ++i)
        if (!was_seen(i, j) && !point(i, j).is_known.load(std::memory_order_acquire)) missing.emplace_back(j, i);
    last = cell;
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());

  std::array<PixelPosition, FragmentBatch::capacity> pixels;
  std::array<Value, FragmentBatch::capacity> values;
  for (std::size_t first = 0; first < missing.size(); first += pixels.size()) {
    const std::size_t count = std::min(pixels.size(), missing.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const auto [j, i] = missing[first + k];
      pixels[k] = {step_ * i - j, i + step_ * j};
    }
    evaluate({pixels.data(), count}, values.data());
    for (std::size_t k = 0; k < count; ++k) point(missing[first + k].second, missing[first + k].first).store(values[k]);
  }
}

VisibilityGrid::Neighbours VisibilityGrid::neighbours_of(const Cell& cell) {
  Neighbours out;
  std::size_t k = 0;
  for (int j = cell.j - 1; j < cell.j - 1 + width; ++j)
    for (int i = cell.i - 1; i < cell.i - 1 + width; ++i, ++k) {
      const Point& p = point(i, j);
      for (std::size_t c = 0; c < 3; ++c) {
        out.position[c][k] = p.position[c].load(std::memory_order_relaxed);
        out.normal[c][k] = p.normal[c].load(std::memory_order_relaxed);
      }
      out.visible[k] = p.visible.load(std::memory_order_relaxed);
      out.is_even = out.is_even && out.visible[k] == out.visible[0];
    }
  return out;
}

float VisibilityGrid::at(const Receivers& r, int i, const Cell& cell, const Neighbours& near) const {
  if (r.is_ground && near.is_even) return near.visible[0];
  const std::array<float, width> across = spline(cell.u), down = spline(cell.v);
  OfNeighbours weight;
  for (std::size_t k = 0; k < neighbours; ++k) weight[k] = across[k % width] * down[k / width];
  float least = 1, greatest = 0;
  int count = 0;
  const auto& [px, py, pz] = near.position;
  const auto& [nx, ny, nz] = near.normal;
  for (std::size_t k = 0; k < neighbours; ++k) {
    const float x = px[k] - r.position[0][i], y = py[k] - r.position[1][i], z = pz[k] - r.position[2][i];
    const float a = r.normal[0][i], b = r.normal[1][i], c = r.normal[2][i];
    const float cosine = nx[k] * a + ny[k] * b + nz[k] * c;
    const float rise = x * (nx[k] + a) + y * (ny[k] + b) + z * (nz[k] + c);
    constexpr float steepest = 4 * greatest_slope * greatest_slope;
    const bool is_on_surface = near.visible[k] != Value::nothing && cosine >= least_cosine &&
                               rise * rise <= steepest * (x * x + y * y + z * z);
    weight[k] = is_on_surface ? weight[k] : 0;
    count += is_on_surface;
    least = is_on_surface ? std::min(least, near.visible[k]) : least;
    greatest = is_on_surface ? std::max(greatest, near.visible[k]) : greatest;
  }
  if (count < least_points) return Value::nothing;
  const Moments moments(weight, near.visible, cell.u, cell.v);
  if (moments.one < least_weight) return Value::nothing;
  if (least == greatest) return least;
  const FittedPlane plane = fit(moments);
  const float visible = std::clamp(plane.at_origin, least, greatest);
  const float error = plane.variance * static_cast<float>(count) / static_cast<float>(count - 3);
  const float allowed = greatest_deviation * greatest_deviation + noise_ * visible * (1 - visible);
  return error <= allowed ? visible : Value::nothing;
}

void VisibilityGrid::interpolate(const Receivers& receivers, std::span<const int> which, const Evaluate& evaluate,
                                 float* visible) {
  evaluate_missing(receivers, which, evaluate);
  Neighbours near;
  Cell last{first_i_ - width, first_j_ - width, 0, 0};
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Cell cell = cell_of(receivers, which[k]);
    if (!cell.is_that_of(last)) near = neighbours_of(cell);
    last = cell;
    visible[k] = at(receivers, which[k], cell, near);
  }
}

}  // namespace zoneplate
