// SPDX-License-Identifier: Apache-2.0
// Separable convolution: both directions in one sweep.
//
// A task processes a block of columns from top to bottom: it filters some rows along x into a buffer that stays in the
// cache, then sums the buffer's rows along y. The intermediate plane is never stored.
#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/channels.h"
#include "zoneplate/signal/filter/convolve.h"
#include "zoneplate/signal/filter/row_sum.h"

namespace zoneplate {
namespace {

constexpr std::size_t strip_floats = 64;  // columns whose sums the kernel keeps in registers
constexpr std::size_t max_strips = 32;    // strips of one task: long runs of a row are read sequentially
constexpr std::size_t min_strips = 8;
// Rows of strips, 256 bytes each, that one task keeps in the second-level cache.
constexpr std::size_t cached_rows = 2048;
constexpr std::size_t step_rows = 16;  // rows that are filtered along x before the next sums along y
constexpr std::size_t min_band = 32;   // rows of one task

// One row of a strip. Aligned, because a vector that straddles two cache lines takes two reads.
struct alignas(64) StripRow {
  float values[strip_floats] = {};
};

template <class T>
constexpr T nothing = T{};
template <>
constexpr Linear nothing<Linear> = {0, 0, 0, 0};

bool is_identity(std::span<const double> taps) { return taps.size() == 1 && taps[0] == 1; }

std::vector<float> as_floats(std::span<const double> taps) {
  std::vector<float> out;
  for (const double t : taps) out.push_back(static_cast<float>(t));
  return out;
}

// The filter along x. The sources of pixels [0, low) and [high, w) include the left or right border: they are first
// copied with the border. The pixels between read the plane itself.
template <class T>
class RowFilter {
 public:
  RowFilter(const Plane<T>& plane, std::span<const double> taps, const ConvolveOptions& options)
      : plane_(plane),
        weights_(as_floats(taps)),
        border_(options.border),
        is_copy_(is_identity(taps)),
        kernels_(RowSumKernels::of()) {
    const std::size_t n = taps.size(), w = static_cast<std::size_t>(plane.width());
    before_ = n - 1 - n / 2;
    // A multiple of whole strips, so that no partial vectors are left between the parts.
    const auto in_strips = [&](std::size_t pixels) {
      const std::size_t unit = strip_floats / channels<T>;
      return std::min(w, (pixels + unit - 1) / unit * unit);
    };
    low_ = in_strips(before_), high_ = std::max(low_, w - in_strips(n / 2));
    for (std::size_t t = 0; t < n; ++t) rows_.push_back(floats(plane.row(0)) + std::min(n - 1 - t, w) * channels<T>);
  }

  // Buffers for the sources of border columns, and the row pointers of the taps.
  struct Edge {
    std::vector<T> pixels;
    std::vector<const float*> rows;
  };
  Edge make_edge() const {
    const std::size_t w = static_cast<std::size_t>(plane_.width());
    Edge edge{std::vector<T>(std::max(low_, w - high_) + weights_.size()), {}};
    for (std::size_t t = weights_.size(); t-- > 0;)
      edge.rows.push_back(floats(std::span<const T>(edge.pixels)) + t * channels<T>);
    return edge;
  }

  // Filters pixels [begin, end) of row y into `out`.
  void operator()(int y, std::size_t begin, std::size_t end, float* out, Edge& edge) const {
    const std::span<const T> row = plane_.row(y);
    if (is_copy_) {
      std::copy_n(floats(row.subspan(begin)), (end - begin) * channels<T>, out);
      return;
    }
    if (begin < low_) sum_edge(row, begin, std::min(end, low_), out, edge);
    const std::size_t a = std::max(begin, low_), b = std::min(end, high_);
    if (a < b) {
      const std::size_t first = static_cast<std::size_t>(y) * row.size() + a - before_;
      kernels_.narrow(rows_.data(), first * channels<T>, weights_.data(), weights_.size(),
                      out + (a - begin) * channels<T>, (b - a) * channels<T>);
    }
    if (end > high_) {
      const std::size_t c = std::max(begin, high_);
      sum_edge(row, c, end, out + (c - begin) * channels<T>, edge);
    }
  }

 private:
  // Computes the sums of pixels [begin, end), whose sources are first copied with their border.
  void sum_edge(std::span<const T> row, std::size_t begin, std::size_t end, float* out, Edge& edge) const {
    const int first = static_cast<int>(begin) - static_cast<int>(before_), w = plane_.width();
    const int seen = static_cast<int>(end - begin + weights_.size() - 1);
    const int inside = std::clamp(-first, 0, seen), outside = std::clamp(w - first, inside, seen);
    const auto copy_border = [&](int i) {
      const int x = border_index(first + i, w, border_);
      edge.pixels[static_cast<std::size_t>(i)] = x < 0 ? nothing<T> : row[static_cast<std::size_t>(x)];
    };
    for (int i = 0; i < inside; ++i) copy_border(i);
    if (outside > inside) std::copy_n(row.begin() + first + inside, outside - inside, edge.pixels.begin() + inside);
    for (int i = outside; i < seen; ++i) copy_border(i);
    kernels_.narrow(edge.rows.data(), 0, weights_.data(), weights_.size(), out, (end - begin) * channels<T>);
  }

  const Plane<T>& plane_;
  std::vector<float> weights_;
  Border border_;
  bool is_copy_;
  const RowSumKernels& kernels_;
  std::size_t before_ = 0, low_ = 0, high_ = 0;
  std::vector<const float*> rows_;
};

// The filtered rows that the current sums along y need, of the columns of one task, strip by strip, in ascending order
// of y.
template <class T>
class Window {
 public:
  Window(const RowFilter<T>& filter, std::size_t rows, std::size_t first_pixel, std::size_t end_pixel)
      : filter_(filter),
        rows_(rows),
        first_(first_pixel),
        end_(end_pixel),
        strip_rows_(rows * (((end_pixel - first_pixel) * channels<T> + strip_floats - 1) / strip_floats)),
        edge_(filter.make_edge()) {}

  // Stores the filtered row y of the plane in row i; zeros if y < 0.
  void fill(std::size_t i, int y) {
    constexpr std::size_t pixels = strip_floats / channels<T>;
    for (std::size_t s = 0, x = first_; x < end_; ++s, x += pixels) {
      float* to = strip_rows_[s * rows_ + i].values;
      y < 0 ? void(std::fill_n(to, strip_floats, 0.0f)) : filter_(y, x, std::min(end_, x + pixels), to, edge_);
    }
  }

  // Drops the first `count` rows.
  void move_up(std::size_t count) {
    for (std::size_t s = 0; s * strip_floats < floats_across(); ++s) {
      const auto strip = strip_rows_.begin() + static_cast<std::ptrdiff_t>(s * rows_);
      std::copy(strip + static_cast<std::ptrdiff_t>(count), strip + static_cast<std::ptrdiff_t>(rows_), strip);
    }
  }

  std::size_t floats_across() const { return (end_ - first_) * channels<T>; }
  const float* strip(std::size_t s) const { return strip_rows_[s * rows_].values; }

 private:
  const RowFilter<T>& filter_;
  std::size_t rows_, first_, end_;
  std::vector<StripRow> strip_rows_;
  typename RowFilter<T>::Edge edge_;
};

// Computes rows [begin, end) of the block of columns [first_x, end_x), in pixels.
template <class T>
void sweep(const RowFilter<T>& filter, std::span<const double> taps, const ConvolveOptions& options, Plane<T>& out,
           std::size_t begin, std::size_t end, std::size_t first_x, std::size_t end_x) {
  const std::vector<float> weights = as_floats(taps);
  const std::size_t n = taps.size(), step = step_rows;
  Window<T> window(filter, n - 1 + step, first_x, end_x);
  const RowSumKernels& kernels = RowSumKernels::of();
  std::vector<const float*> rows(n);
  const auto fill = [&](std::size_t i, std::size_t y) {
    const int above = static_cast<int>(n - 1 - n / 2);
    window.fill(i, border_index(static_cast<int>(y + i) - above, out.height(), options.border));
  };
  for (std::size_t i = 0; i < n - 1; ++i) fill(i, begin);
  for (std::size_t y = begin; y < end; y += step) {
    const std::size_t count = std::min(step, end - y);
    for (std::size_t i = n - 1; i < n - 1 + count; ++i) fill(i, y);
    for (std::size_t s = 0; s * strip_floats < window.floats_across(); ++s) {
      const std::size_t x = s * strip_floats;
      for (std::size_t t = 0; t < n; ++t) rows[t] = window.strip(s) + (n - 1 - t) * strip_floats;
      for (std::size_t i = 0; i < count; ++i) {
        // The next rows are on other pages, which the hardware prefetcher does not reach.
        const auto row_at = [&](std::size_t r) { return floats(out.row(static_cast<int>(r)).subspan(first_x)) + x; };
        for (std::size_t line = 0; line < strip_floats; line += 16)
          __builtin_prefetch(row_at(std::min(end - 1, y + i + 6)) + line, 1);
        kernels.narrow(rows.data(), i * strip_floats, weights.data(), n, row_at(y + i),
                       std::min(strip_floats, window.floats_across() - x));
      }
    }
    window.move_up(step);
  }
}

template <class T>
Plane<T> separable(const Plane<T>& plane, std::span<const double> along_rows, std::span<const double> along_columns,
                   const ConvolveOptions& options, Plane<T> room) {
  assert(!along_rows.empty() && !along_columns.empty());
  if (plane.empty()) return plane;
  const auto w = static_cast<std::size_t>(plane.width()), h = static_cast<std::size_t>(plane.height());
  // Every value is overwritten below, so that the contents of `room` are irrelevant.
  const bool has_room = room.width() == plane.width() && room.height() == plane.height();
  Plane<T> out = has_room ? std::move(room) : Plane<T>(plane.width(), plane.height());
  const RowFilter<T> filter(plane, along_rows, options);
  if (is_identity(along_columns)) {
    parallel_ranges(h, min_band, [&](std::size_t begin, std::size_t end) {
      auto edge = filter.make_edge();
      for (std::size_t y = begin; y < end; ++y) {
        const int row = static_cast<int>(y);
        filter(row, 0, w, floats(out.row(row)), edge);
      }
    });
    return out;
  }

  // The partition into tasks affects the time but no value, because each value is the same sum in any partition. Each
  // band filters the rows above its first sums again, so that there are no more bands than threads need.
  const std::size_t n = along_columns.size();
  const std::size_t strips = std::clamp(cached_rows / (n - 1 + step_rows), min_strips, max_strips);
  const std::size_t across = strips * strip_floats / channels<T>, blocks = (w + across - 1) / across;
  const auto threads = static_cast<std::size_t>(thread_limit());
  const std::size_t preferred = threads == 1 ? 1 : (2 * threads + blocks - 1) / blocks;
  const std::size_t bands = std::clamp<std::size_t>(preferred, 1, std::max<std::size_t>(1, h / std::max(min_band, n)));
  const std::size_t band = (h + bands - 1) / bands;
  parallel_for(bands * blocks, [&](std::size_t task) {
    const std::size_t y = std::min(h, task / blocks * band), x = task % blocks * across;
    sweep(filter, along_columns, options, out, y, std::min(h, y + band), x, std::min(w, x + across));
  });
  return out;
}

}  // namespace

Plane<float> convolve_separable(const Plane<float>& plane, std::span<const double> along_rows,
                                std::span<const double> along_columns, const ConvolveOptions& options,
                                Plane<float> room) {
  return separable(plane, along_rows, along_columns, options, std::move(room));
}
LinearImage convolve_separable(const LinearImage& image, std::span<const double> along_rows,
                               std::span<const double> along_columns, const ConvolveOptions& options,
                               LinearImage room) {
  return separable(image, along_rows, along_columns, options, std::move(room));
}

}  // namespace zoneplate
