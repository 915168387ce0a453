// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/sampling/sample_accumulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "zoneplate/antialias/sampling/accumulate.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/display_transform.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t room = 8;             // pixels beyond a row that kernels may access
constexpr std::size_t rows_of_a_part = 32;  // rows per thread
constexpr int max_radius = 4;               // of a kernel of radius 4

/// The kernel's values at a sample's distances from the centres of the neighbouring pixels, the leftmost first.
std::vector<float> taps_of(const ResolveFilter& filter, std::uint8_t offset) {
  const int radius = filter.radius();
  if (!filter.kernel) return {1};
  std::vector<float> taps;
  for (int d = -radius; d <= radius; ++d)
    taps.push_back(static_cast<float>(filter.kernel->value(d + offset / 256.0 - 0.5)));
  return taps;
}

}  // namespace

/// The mapped samples of a row and their weights, padded with zeros as far as a filter reaches beyond the image.
class SampleRow {
 public:
  SampleRow(int width, int radius)
      : width_(static_cast<std::size_t>(width)),
        before_(static_cast<std::size_t>(radius)),
        color_(4 * (width_ + 2 * before_ + room)),
        weight_(width_ + 2 * before_ + room) {
    std::fill_n(weight_.begin() + radius, width, 1.0f);
  }

  void take(std::span<const Linear> samples, SampleWeight weight, const DisplayOptions& display) {
    float* const color = color_.data() + 4 * before_;
    if (weight == SampleWeight::Display || weight == SampleWeight::Encoded) {
      if (weight == SampleWeight::Display)
        show_light(samples, display, color);
      else
        show_encoded(samples, display, color);
      return AccumulateKernels::of().premultiply(color, width_);
    }
    std::copy_n(&samples.data()->r, 4 * width_, color);
    if (weight == SampleWeight::Max3) AccumulateKernels::of().map_max3(color, width_);
    if (weight != SampleWeight::Karis) return;
    AccumulateKernels::of().weigh_karis(display.exposure, color, weight_.data() + before_, width_);
    std::fill(weight_.begin() + static_cast<std::ptrdiff_t>(before_ + width_), weight_.end(), 0.0f);
  }

  const float* color() const { return color_.data(); }
  const float* weight() const { return weight_.data(); }

 private:
  std::size_t width_, before_;
  std::vector<float> color_, weight_;
};

int ResolveFilter::radius() const { return kernel ? static_cast<int>(std::ceil(kernel->radius + 0.5)) - 1 : 0; }

ResolveFilter resolve_filter_of(std::string_view method, const Settings& settings) {
  ResolveFilter out{.weight = static_cast<SampleWeight>(settings.integer("resolve")), .kernel = {}};
  if (settings.chosen("mix") == "codes") {
    if (out.weight == SampleWeight::Karis || out.weight == SampleWeight::Max3)
      throw Error(ErrorKind::Usage, fmt::format("{}: resolve={} weighs scene-linear values, mix=codes averages "
                                                "sRGB-encoded ones: give one of them",
                                                method, settings.chosen("resolve")));
    out.weight = SampleWeight::Encoded;
  }
  const double radius = settings.number("radius");
  if (settings.integer("filter") == 0) {
    if (settings.is_given("radius"))
      throw Error(ErrorKind::Usage, std::string(method) + ": radius needs a filter, for example filter=mitchell");
    return out;
  }
  out.kernel = make_kernel(settings.chosen("filter"));
  if (radius > 0) out.kernel = stretched(std::move(*out.kernel), radius / out.kernel->radius);
  return out;
}

void SampleAccumulator::begin(int width, int height) {
  width_ = width, height_ = height;
  stride_ = (static_cast<std::size_t>(width) + room - 1) / room * room;
  sum_.assign(4 * stride_ * static_cast<std::size_t>(height), 0);
  weight_.assign(stride_ * static_cast<std::size_t>(height), 0);
}

void SampleAccumulator::add(const Frame& frame, std::span<const SamplePosition> positions) {
  if (sum_.empty()) begin(frame.sample_color[0].width(), frame.sample_color[0].height());
  std::vector<Taps> taps;
  for (const SamplePosition p : positions) taps.push_back({taps_of(filter_, p.x), taps_of(filter_, p.y)});
  parallel_ranges(static_cast<std::size_t>(height_), rows_of_a_part, [&](std::size_t first, std::size_t last) {
    add_rows(frame, taps, static_cast<int>(first), static_cast<int>(last));
  });
}

/// Adds the contributions of all samples to rows [first, last) of the sums.
void SampleAccumulator::add_rows(const Frame& frame, std::span<const Taps> taps, int first, int last) {
  const int radius = filter_.radius();
  SampleRow row(width_, radius);
  for (std::size_t s = 0; s < taps.size(); ++s)
    for (int y = std::max(first - radius, 0); y < std::min(last + radius, height_); ++y) {
      row.take(frame.sample_color[s].row(y), filter_.weight, frame.display);
      spread(row, taps[s], y, std::max(first, y - radius), std::min(last, y + radius + 1));
    }
}

/// Adds row y of samples to rows [first, last) of the sums.
void SampleAccumulator::spread(const SampleRow& row, const Taps& taps, int y, int first, int last) {
  std::array<float*, 2 * max_radius + 1> colors, weights;
  std::array<float, 2 * max_radius + 1> down;
  const int radius = filter_.radius(), count = last - first, wide = static_cast<int>(taps.across.size());
  assert(radius <= max_radius);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i), to = static_cast<std::size_t>(first + i) * stride_;
    colors[at] = &sum_[4 * to], weights[at] = &weight_[to];
    down[at] = taps.down[static_cast<std::size_t>(y - (first + i) + radius)];
  }
  const auto n = static_cast<std::size_t>(width_);
  AccumulateKernels::of().spread(row.color(), 4, taps.across.data(), wide, down.data(), colors.data(), count, 4 * n);
  AccumulateKernels::of().spread(row.weight(), 1, taps.across.data(), wide, down.data(), weights.data(), count, n);
}

LinearImage SampleAccumulator::light() const {
  LinearImage out(width_, height_);
  parallel_ranges(static_cast<std::size_t>(height_), rows_of_a_part, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y)
      AccumulateKernels::of().mean(&sum_[4 * y * stride_], &weight_[y * stride_], filter_.weight == SampleWeight::Max3,
                                   &out.row(static_cast<int>(y)).data()->r, static_cast<std::size_t>(width_));
  });
  return out;
}

DisplayImage SampleAccumulator::display_referred(DisplayImage image, const DisplayOptions& display) const {
  if (!filter_.is_display_referred()) return image;
  // Averages of encoded values are encoded already.
  return make_display(light(), {.is_transparent = true, .raw = display.raw || filter_.weight == SampleWeight::Encoded});
}

}  // namespace zoneplate::antialias
