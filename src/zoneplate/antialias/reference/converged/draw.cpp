// SPDX-License-Identifier: Apache-2.0
// The converged image: passes of a few samples over one strip of the image at a time, each accumulated immediately.
#include "zoneplate/antialias/reference/converged/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "zoneplate/antialias/reference/converged/pattern.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t groups = 4;
constexpr std::size_t pass_samples = 16;
constexpr std::size_t strip_bytes = std::size_t{1} << 27;  // bytes of sample planes

/// Weighted sums of a pixel's samples.
struct Sum {
  double r = 0, g = 0, b = 0, a = 0, weight = 0;
};

Sum operator+(const Sum& p, const Sum& q) { return {p.r + q.r, p.g + q.g, p.b + q.b, p.a + q.a, p.weight + q.weight}; }

/// The filter along one axis: its value for each neighbouring pixel and each sample.
class AxisWeights {
 public:
  AxisWeights(const std::function<double(double)>& value, int radius, std::span<const std::uint8_t> places)
      : radius_(radius), samples_(places.size()) {
    for (int k = -radius; k <= radius; ++k)
      for (const std::uint8_t place : places) weights_.push_back(value(k + place / 256.0 - 0.5));
  }
  double operator()(int k, std::size_t sample) const {
    return weights_[static_cast<std::size_t>(k + radius_) * samples_ + sample];
  }

 private:
  int radius_;
  std::size_t samples_;
  std::vector<double> weights_;
};

/// A filter as a function of the position along an axis.
struct AxisFilter {
  std::function<double(double)> value;
  int radius = 0;
};

AxisFilter axis_filter(const std::string& name) {
  if (name == "box") return {[](double) { return 1.0; }, 0};
  if (name == "quadratic")
    return {[](double x) {
              const double a = std::abs(x), rest = 1.5 - a;
              return a < 0.5 ? 0.75 - a * a : a < 1.5 ? rest * rest / 2 : 0.0;
            },
            1};
  const Kernel kernel = make_kernel(name);
  return {kernel.value, static_cast<int>(std::ceil(kernel.radius - 0.5))};
}

class Strips {
 public:
  Strips(const CustomDraw& drawing, const ConvergedOptions& options)
      : drawing_(drawing),
        rules_(drawing.rules),
        pattern_(scrambled_pattern(options.samples)),
        filter_(axis_filter(options.filter)) {
    rules_.progress = nullptr;  // of a pass over a strip, not of the image
    std::vector<std::uint8_t> x, y;
    for (const SamplePosition p : pattern_) x.push_back(p.x), y.push_back(p.y);
    across_.emplace(filter_.value, filter_.radius, x);
    down_.emplace(filter_.value, filter_.radius, y);
    if (options.order == FilterOrder::Display) shown_.emplace(drawing.options.display);
  }

  void draw() {
    const Target& whole = drawing_.target;
    const auto width = static_cast<std::size_t>(whole.width + 2 * filter_.radius);
    const std::size_t row_bytes = width * pass_samples * (sizeof(Linear) + sizeof(float) + sizeof(std::uint32_t));
    const int rows = static_cast<int>(std::clamp<std::size_t>(strip_bytes / row_bytes, 16, 4096));
    for (int y = whole.y; y < whole.y + whole.height; y += rows)
      draw_strip(y, std::min(rows, whole.y + whole.height - y));
  }

 private:
  void draw_strip(int top, int height) {
    begin_strip(top, height);
    const std::size_t step = std::min(pass_samples, pattern_.size() / groups);
    for (std::size_t first = 0; first < pattern_.size(); first += step) {
      strip_.samples.assign(pattern_.begin() + static_cast<std::ptrdiff_t>(first),
                            pattern_.begin() + static_cast<std::ptrdiff_t>(first + step));
      const RasterCounts pass = rasterize(drawing_.draws, drawing_.shader, rules_, strip_, &memory_);
      drawing_.counts.geometry_ms += pass.geometry_ms;
      drawing_.counts.tiles_ms += pass.tiles_ms;
      drawing_.counts.shaded += pass.shaded;
      drawing_.counts.triangles = pass.triangles;
      drawing_.counts.set_up = std::max(drawing_.counts.set_up, pass.set_up);
      add_pass(first, step);
      const double rows = top + height * static_cast<double>(first + step) / static_cast<double>(pattern_.size());
      if (drawing_.options.progress) drawing_.options.progress((rows - drawing_.target.y) / drawing_.target.height);
    }
    write_strip();
  }

  /// Starts a strip: its pixels, and the neighbouring pixels within the radius of the filter.
  void begin_strip(int top, int height) {
    const Target& whole = drawing_.target;
    top_ = top, height_ = height;
    strip_ = Target{};
    strip_.viewport = whole.viewport;
    strip_.is_per_sample = true;
    if (drawing_.options.sample_footprint) strip_.spacing = 1 / std::sqrt(static_cast<float>(pattern_.size()));
    strip_.x = std::max(whole.x - filter_.radius, 0);
    strip_.y = std::max(top - filter_.radius, 0);
    strip_.width = std::min(whole.x + whole.width + filter_.radius, whole.viewport.width) - strip_.x;
    strip_.height = std::min(top + height + filter_.radius, whole.viewport.height) - strip_.y;
    color_.assign(pass_samples, LinearImage(strip_.width, strip_.height));
    depth_.assign(pass_samples, Plane<float>(strip_.width, strip_.height));
    triangle_.assign(pass_samples, Plane<std::uint32_t>(strip_.width, strip_.height));
    strip_.sample_color = &color_;
    strip_.sample_depth = &depth_;
    strip_.sample_triangle = &triangle_;
    for (Plane<Sum>& group : sums_) group = Plane<Sum>(whole.width, height);
    covered_ = Plane<int>(whole.width, height);
  }

  void add_pass(std::size_t first, std::size_t count) {
    if (shown_)
      parallel_for(count * static_cast<std::size_t>(strip_.height), [&](std::size_t i) {
        for (Linear& c : color_[i % count].row(static_cast<int>(i / count))) c = (*shown_)(c);
      });
    Plane<Sum>& sums = sums_[first * groups / pattern_.size()];
    parallel_for(static_cast<std::size_t>(height_), [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int ky = -filter_.radius; ky <= filter_.radius; ++ky)
        for (int kx = -filter_.radius; kx <= filter_.radius; ++kx) {
          std::array<double, pass_samples> weight{};
          for (std::size_t s = 0; s < count; ++s) weight[s] = (*across_)(kx, first + s) * (*down_)(ky, first + s);
          add_row(sums.row(y), top_ + y + ky, kx, std::span(weight).first(count));
        }
      for (std::size_t s = 0; s < count; ++s)
        for (int x = 0; x < covered_.width(); ++x)
          covered_(x, y) += triangle_[s](drawing_.target.x + x - strip_.x, top_ + y - strip_.y) != Target::no_id;
    });
  }

  /// Adds the samples of row y of the image to the sums, each from the pixel that is kx to the right.
  void add_row(std::span<Sum> sums, int y, int kx, std::span<const double> weight) const {
    if (y < 0 || y >= strip_.viewport.height) return;
    const int left = drawing_.target.x + kx;
    const int begin = std::max(0, -left), end = std::min(drawing_.target.width, strip_.viewport.width - left);
    std::array<const Linear*, pass_samples> from{};
    for (std::size_t s = 0; s < weight.size(); ++s) from[s] = color_[s].row(y - strip_.y).data();
    for (int x = begin; x < end; ++x) {
      Sum sum = sums[static_cast<std::size_t>(x)];
      for (std::size_t s = 0; s < weight.size(); ++s) {
        const Linear& c = from[s][left + x - strip_.x];
        const double w = weight[s];
        sum = {sum.r + w * c.r, sum.g + w * c.g, sum.b + w * c.b, sum.a + w * c.a, sum.weight + w};
      }
      sums[static_cast<std::size_t>(x)] = sum;
    }
  }

  void write_strip() const {
    const Target& whole = drawing_.target;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < whole.width; ++x) {
        const std::array<Sum, groups> sum{sums_[0](x, y), sums_[1](x, y), sums_[2](x, y), sums_[3](x, y)};
        const Sum all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
        const auto mean = [&](double v) { return static_cast<float>(v / all.weight); };
        const int py = top_ + y - whole.y;
        (*whole.color)(x, py) = {mean(all.r), mean(all.g), mean(all.b), mean(all.a)};
        if (drawing_.error) (*drawing_.error)(x, py) = standard_error(sum, all);
        if (whole.coverage)
          (*whole.coverage)(x, py) = static_cast<float>(covered_(x, y)) / static_cast<float>(pattern_.size());
      }
  }

  /// The standard error of the mean of the groups' means, the greatest of the channels.
  static float standard_error(const std::array<Sum, groups>& sum, const Sum& all) {
    double greatest = 0;
    for (double Sum::*channel : {&Sum::r, &Sum::g, &Sum::b, &Sum::a}) {
      double squares = 0;
      for (const Sum& s : sum) {
        const double off = s.*channel / s.weight - all.*channel / all.weight;
        squares += off * off;
      }
      greatest = std::max(greatest, squares);
    }
    return static_cast<float>(std::sqrt(greatest / (groups * (groups - 1))));
  }

  const CustomDraw& drawing_;
  RasterRules rules_;
  const SamplePattern pattern_;
  const AxisFilter filter_;
  std::optional<AxisWeights> across_, down_;
  std::optional<DisplayLight> shown_;
  RasterMemory memory_;

  int top_ = 0, height_ = 0;  ///< of the strip, without the neighbouring pixels
  Target strip_;
  std::vector<LinearImage> color_;
  std::vector<Plane<float>> depth_;
  std::vector<Plane<std::uint32_t>> triangle_;
  std::array<Plane<Sum>, groups> sums_;
  Plane<int> covered_;  ///< number of samples that hit a surface
};

}  // namespace

void draw_converged(const CustomDraw& drawing, const ConvergedOptions& options) { Strips(drawing, options).draw(); }

}  // namespace zoneplate::antialias
