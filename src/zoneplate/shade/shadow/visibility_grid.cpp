// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/visibility_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

/// Cells of a neighbourhood along one axis, of which the second is the receiver's own.
constexpr int width = 4;
/// The most pixels of a cell.
constexpr int most_per_cell = 2;
/// Cells along a side of a block.
constexpr int block_side = 16;

/// Of the normals of points of one surface.
constexpr float least_cosine = 0.98f;
/// The greatest sine of the angle between the line of two points and the plane across the sum of their normals: this at
/// least, and the sine of the angle between the normals. It is 0 on a circle. By 0.02 in place of 0.1 the RMS of ten
/// scenes is the same, and the time up to 1.2 times as long.
constexpr float least_slope = 0.1f;
/// The sine of the slope from which on a point is above a surface, whose shadow may begin there. A pane 0.1 above a
/// floor (RMS to 1,024 rays, 320 × 240): 0.0037 by this value, 0.013 by 0.3, at which Suzanne takes 0.7 of the time.
constexpr float occluding_slope = 0.15f;
/// The least sum of the weights of the points on the surface; that of all is 1.
constexpr float least_weight = 0.3f;
/// The fewest such points.
constexpr int least_points = 6;
/// The greatest standard deviation of values from the fitted plane, besides their error.
constexpr float greatest_deviation = 0.03f;
/// The variance of the mean of evenly distributed rays, relative to that of as many independent ones.
constexpr float evenness = 0.3f;
/// Weight of a plane without slope, relative to that of the points: where these lie on a line, it decides across.
constexpr float flatness = 0.005f;

/// Rounds down.
int quotient(int a, int b) { return a / b - (a % b < 0); }

/// The cubic B-spline.
float spline(float t) {
  constexpr float sixth = 1 / 6.0f;
  const float d = std::abs(t), rest = std::max(0.0f, 2 - d);
  return (d < 1 ? 4 - 6 * d * d + 3 * d * d * d : rest * rest * rest) * sixth;
}

/// The most pixels about a cell.
constexpr std::size_t most_neighbours = std::size_t{width} * width * most_per_cell;
using OfNeighbours = std::array<float, most_neighbours>;

/// Weighted moments of places (x, y) and values.
struct Moments {
  float one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, f = 0, xf = 0, yf = 0, ff = 0;

  Moments(const OfNeighbours& weight, const OfNeighbours& value, const OfNeighbours& px, const OfNeighbours& py,
          std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const float wx = weight[k] * px[k], wy = weight[k] * py[k], wf = weight[k] * value[k];
      one += weight[k], x += wx, y += wy, xx += wx * px[k], xy += wx * py[k], yy += wy * py[k];
      f += wf, xf += wx * value[k], yf += wy * value[k], ff += wf * value[k];
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
  std::atomic<std::uint32_t> surface;

  void store(const Value& v) {
    const auto put = [](std::array<std::atomic<float>, 3>& to, float3 from) {
      to[0].store(from.x, std::memory_order_relaxed);
      to[1].store(from.y, std::memory_order_relaxed);
      to[2].store(from.z, std::memory_order_relaxed);
    };
    put(position, v.position), put(normal, v.normal);
    surface.store(v.surface, std::memory_order_relaxed);
    visible.store(v.visible, std::memory_order_relaxed);
    is_known.store(true, std::memory_order_release);
  }
};

struct VisibilityGrid::Block {
  std::array<Point, std::size_t{block_side} * block_side * most_per_cell> points;
};

/// The pixels about a cell: by coordinate, then by row, column and number.
struct VisibilityGrid::Neighbours {
  OfNeighbours x, y;  ///< along the axes of the lattice, from the cell's point
  std::array<OfNeighbours, 3> position, normal;
  std::array<std::uint32_t, most_neighbours> surface;
  OfNeighbours visible;
  std::size_t count = 0;
  bool is_even = true;  ///< all have the same value
};

VisibilityGrid::VisibilityGrid(int step, int w, int h, int rays)
    : step_(step), per_cell_(step > 2 ? most_per_cell : 1), noise_(evenness / static_cast<float>(rays)) {
  const int det = step * step + 1;
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

VisibilityGrid::Cell VisibilityGrid::cell_of(const Receivers& receivers, int k) const {
  constexpr int unit = 256;
  const int x = receivers.x[k] - unit / 2, y = receivers.y[k] - unit / 2, whole = unit * (step_ * step_ + 1);
  const int along = step_ * x + y, down = step_ * y - x;
  const int i = quotient(along, whole), j = quotient(down, whole);
  const float scale = 1 / static_cast<float>(whole);
  return {i, j, static_cast<float>(along - i * whole) * scale, static_cast<float>(down - j * whole) * scale};
}

PixelPosition VisibilityGrid::pixel_of(int i, int j, int n) const {
  // A place in [0, step) along both axes: x in its own part of them.
  const auto place = [&](int from, int to, int axis) {
    const std::uint32_t random =
        hash(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(2 * n + axis));
    return from + static_cast<int>(random % static_cast<std::uint32_t>(to - from));
  };
  return {step_ * i - j + place(step_ * n / per_cell_, step_ * (n + 1) / per_cell_, 0) - step_ / 2,
          i + step_ * j + place(0, step_, 1) - step_ / 2};
}

/// The first thread that needs a block makes it.
VisibilityGrid::Point& VisibilityGrid::point(int i, int j, int n) {
  const auto column = static_cast<unsigned>(i - first_i_), row = static_cast<unsigned>(j - first_j_);
  assert(i >= first_i_ && j >= first_j_ && static_cast<int>(column / block_side) < row_);
  std::atomic<Block*>& block =
      blocks_[std::size_t{row / block_side} * static_cast<std::size_t>(row_) + column / block_side];
  Block* found = block.load(std::memory_order_acquire);
  if (found == nullptr) {
    auto made = growing("sharing of visibility", [] { return std::make_unique<Block>(); });
    if (block.compare_exchange_strong(found, made.get(), std::memory_order_acq_rel)) found = made.release();
  }
  return found
      ->points[(row % block_side * block_side + column % block_side) * most_per_cell + static_cast<unsigned>(n)];
}

void VisibilityGrid::evaluate_missing(const Receivers& receivers, std::span<const int> which,
                                      const Evaluate& evaluate) {
  std::vector<std::array<int, 3>> missing;  // j, i and number
  Cell last{first_i_ - width, first_j_ - width, 0, 0};
  for (const int k : which) {
    const Cell cell = cell_of(receivers, k);
    if (cell.is_that_of(last)) continue;
    const auto was_seen = [&](int i, int j) {
      return static_cast<unsigned>(i - last.i + 1) < width && static_cast<unsigned>(j - last.j + 1) < width;
    };
    for (int j = cell.j - 1; j < cell.j - 1 + width; ++j)
      for (int i = cell.i - 1; i < cell.i - 1 + width; ++i)
        for (int n = 0; n < per_cell_ && !was_seen(i, j); ++n)
          if (!point(i, j, n).is_known.load(std::memory_order_acquire)) missing.push_back({j, i, n});
    last = cell;
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());

  std::array<PixelPosition, FragmentBatch::capacity> pixels;
  std::array<Value, FragmentBatch::capacity> values;
  for (std::size_t first = 0; first < missing.size(); first += pixels.size()) {
    const std::size_t count = std::min(pixels.size(), missing.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const auto [j, i, n] = missing[first + k];
      pixels[k] = pixel_of(i, j, n);
    }
    evaluate({pixels.data(), count}, values.data());
    for (std::size_t k = 0; k < count; ++k) {
      const auto [j, i, n] = missing[first + k];
      point(i, j, n).store(values[k]);
    }
  }
}

VisibilityGrid::Neighbours VisibilityGrid::neighbours_of(const Cell& cell) {
  Neighbours out;
  const float scale = 1 / static_cast<float>(step_ * step_ + 1);
  std::size_t& k = out.count;
  for (int j = cell.j - 1; j < cell.j - 1 + width; ++j)
    for (int place = 0; place < width * per_cell_; ++place, ++k) {
      const int i = cell.i - 1 + place / per_cell_, n = place % per_cell_;
      const Point& p = point(i, j, n);
      const PixelPosition pixel = pixel_of(i, j, n);
      out.x[k] = static_cast<float>(step_ * pixel.x + pixel.y) * scale - static_cast<float>(cell.i);
      out.y[k] = static_cast<float>(step_ * pixel.y - pixel.x) * scale - static_cast<float>(cell.j);
      out.surface[k] = p.surface.load(std::memory_order_relaxed);
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
  if (r.is_ground && near.is_even && near.visible[0] >= 0) return near.visible[0];
  OfNeighbours weight, across, down, above;
  float least = 1, greatest = 0, reach = 0;
  int count = 0;
  const auto& [px, py, pz] = near.position;
  const auto& [nx, ny, nz] = near.normal;
  for (std::size_t k = 0; k < near.count; ++k) {
    const float x = px[k] - r.position[0][i], y = py[k] - r.position[1][i], z = pz[k] - r.position[2][i];
    const float a = r.normal[0][i], b = r.normal[1][i], c = r.normal[2][i];
    const float cosine = nx[k] * a + ny[k] * b + nz[k] * c;
    const float rise = x * (nx[k] + a) + y * (ny[k] + b) + z * (nz[k] + c);
    const float steepest = 4 * (least_slope * least_slope + std::max(0.0f, 1 - cosine * cosine));
    across[k] = near.x[k] - cell.u, down[k] = near.y[k] - cell.v;
    weight[k] = spline(across[k]) * spline(down[k]);
    const float distance = x * x + y * y + z * z, height = x * a + y * b + z * c;
    const bool is_of_surface =
        near.surface[k] == r.surface[i] && cosine >= least_cosine && rise * rise <= steepest * distance;
    const bool is_on_surface = weight[k] > 0 && is_of_surface && near.visible[k] >= 0;
    const bool is_above = weight[k] > 0 && !is_of_surface && near.visible[k] != Value::nothing && height > 0 &&
                          height * height > occluding_slope * occluding_slope * distance;
    above[k] = is_above ? distance : HUGE_VALF;
    reach = is_on_surface ? std::max(reach, distance) : reach;
    weight[k] = is_on_surface ? weight[k] : 0;
    count += is_on_surface;
    least = is_on_surface ? std::min(least, near.visible[k]) : least;
    greatest = is_on_surface ? std::max(greatest, near.visible[k]) : greatest;
  }
  if (count < least_points) return Value::nothing;
  constexpr float close = 4;  // twice as far
  if (std::any_of(above.begin(), above.begin() + static_cast<std::ptrdiff_t>(near.count),
                  [&](float distance) { return distance <= close * reach; }))
    return Value::nothing;
  const Moments moments(weight, near.visible, across, down, near.count);
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
