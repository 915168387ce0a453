// SPDX-License-Identifier: Apache-2.0
// ColorVideoVDP: the visible difference between two images on a display with stated properties.
//
// Each image is converted to the light of the display, to opponent colours, and to bands of contrast. Differences are
// weighted by contrast sensitivity, masked by contrast that both images have, and pooled to one number, which was
// fitted to subjective ratings.
//
// Weaknesses: differences just at the threshold of visibility, to which it was not fitted; and it does not model eye
// movements.
#include "zoneplate/metrics/cvvdp/cvvdp.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "zoneplate/metrics/cvvdp/pyramid.h"
#include "zoneplate/metrics/cvvdp/sensitivity.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

// Fitted by the authors (parameters of version 0.5.6); indexed by channel 0 to 3.
constexpr std::array<double, 4> channel_gain = {1, 1.45, 1, 1};
constexpr double sensitivity_decibels = -0.2797423303127289;
constexpr double difference_exponent = 2.264355182647705;
constexpr double mask_decades = -0.7954971194267273;
constexpr std::array<double, 4> mask_exponent = {1.302622675895691, 2.8885908126831055, 3.6807713508605957,
                                                 3.588787317276001};
/// log2 of the weight with which one channel (row) masks another (column).
constexpr double mask_weight[4][4] = {
    {-0.18950104713439941, -5.962151050567627, -4.31834602355957, -1.9321587085723877},
    {2.5655593872070312, 0.34406712651252747, -2.719646453857422, -0.4970424771308899},
    {3.8118371963500977, -1.0051705837249756, -0.5193376541137695, -0.5653647780418396},
    {-7.054771423339844, -5.527150630950928, -3.5106418132781982, -2.08804988861084}};
constexpr double max_difference_decades = 2.5642454624176025;
constexpr std::array<double, 4> channel_weight = {1, 1, 1, 0.8081134557723999};
constexpr std::array<double, 4> baseband_weight = {0.0036334486212581396, 1.6627724170684814, 4.11874532699585,
                                                   25.25969886779785};
constexpr double quality_factor = 0.0439569391310215, quality_exponent = 0.9302042722702026;
constexpr double linear_below = 0.1;  // below this difference, quality is linear
constexpr double max_contrast = 1000, min_luminance = 0.01;

double ten_to(double x) { return natural_exp(x * std::numbers::ln10); }

/// x^p for x >= 0 with the finite slope at 0 of the fitted model: (x + e)^p - e^p.
class SoftPower {
 public:
  explicit SoftPower(double exponent) : exponent_(exponent), offset_(power(epsilon, exponent)) {}
  double operator()(double x) const { return power(x + epsilon, exponent_) - offset_; }

 private:
  static constexpr double epsilon = 1e-5;
  double exponent_, offset_;
};

/// (Σ x^p)^(1/p).
double norm(std::span<const double> values, double p) {
  const SoftPower inner(p), outer(1 / p);
  double sum = 0;
  for (const double value : values) sum += inner(value);
  return outer(sum);
}

using Mask = Plane<std::uint8_t>;  ///< 1 at ignored pixels; empty if there are none

/// The root mean square of `value_at(index)` over the pixels of a band that are measured.
template <class ValueAt>
double pooled(int width, int height, const Mask& is_ignored, const ValueAt& value_at) {
  constexpr double epsilon = 1e-5;  // SoftPower(2) is x² + 2 e x
  const double sum = sum_rows(height, [&](int y) {
    double row = 0;
    for (int x = 0; x < width; ++x) {
      if (!is_ignored.empty() && is_ignored(x, y) != 0) continue;
      const double value = value_at(x, y);
      row += value * (value + 2 * epsilon);
    }
    return row;
  });
  const auto ignored = static_cast<double>(std::ranges::count(is_ignored.values(), std::uint8_t{1}));
  return SoftPower(0.5)(sum / (static_cast<double>(width) * height - ignored));
}

/// One level of an image's pyramid as contrast, and the luminance that the contrast is relative to.
struct Band {
  OpponentPlanes contrast;
  Plane<double> luminance;
};

/// The difference between a level and its prediction from the next coarser level, divided by the luminance of that
/// prediction.
Band make_band(const OpponentPlanes& level, const OpponentPlanes& below, double factor) {
  const int width = level[0].width(), height = level[0].height();
  Band band;
  for (std::size_t c = 0; c < level.size(); ++c) {
    Plane<double> predicted = expand(below[c], width, height);
    if (c == 0) {
      band.luminance = predicted;
      for (double& v : band.luminance.values()) v = std::max(min_luminance, v);
    }
    for_rows(height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        const double contrast = (level[c](x, y) - predicted(x, y)) / band.luminance(x, y);
        predicted(x, y) = std::min(contrast, max_contrast) * factor;
      }
    });
    band.contrast.push_back(std::move(predicted));
  }
  return band;
}

/// Weights both bands by the contrast sensitivity at the reference's luminance.
void weigh(Band& reference, Band& test, double frequency) {
  std::vector<Sensitivity> sensitivities;
  for (std::size_t c = 0; c < reference.contrast.size(); ++c) {
    sensitivities.emplace_back(static_cast<int>(c), frequency);
  }
  const double correction = ten_to(sensitivity_decibels / 20);
  for_rows(reference.luminance.height(), [&](int y) {
    for (int x = 0; x < reference.luminance.width(); ++x) {
      const double log_luminance = decimal_log(reference.luminance(x, y));
      for (std::size_t c = 0; c < sensitivities.size(); ++c) {
        const double weight = sensitivities[c].at_log(log_luminance) * correction * channel_gain[c];
        reference.contrast[c](x, y) *= weight;
        test.contrast[c](x, y) *= weight;
      }
    }
  });
}

/// Convolves with a Gaussian of sigma 3 over 13 × 13 pixels, mirrored about the border's pixel; bands of at most 6
/// pixels are unchanged.
Plane<double> blurred(const Plane<double>& in) {
  constexpr int radius = 6;
  if (in.width() <= radius || in.height() <= radius) return in;
  std::array<double, 2 * radius + 1> taps{};
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    sum += taps[static_cast<std::size_t>(i + radius)] = natural_exp(-i * i / (2.0 * 3 * 3));
  }
  const auto mirrored = [](int i, int n) { return i < 0 ? -i : i >= n ? 2 * n - 2 - i : i; };
  Plane<double> rows(in.width(), in.height()), out(in.width(), in.height());
  for_rows(in.height(), [&](int y) {
    for (int x = 0; x < in.width(); ++x) {
      for (int i = -radius; i <= radius; ++i) {
        rows(x, y) += taps[static_cast<std::size_t>(i + radius)] / sum * in(mirrored(x + i, in.width()), y);
      }
    }
  });
  for_rows(in.height(), [&](int y) {
    for (int i = -radius; i <= radius; ++i) {
      const double tap = taps[static_cast<std::size_t>(i + radius)] / sum;
      const auto from = rows.row(mirrored(y + i, in.height()));
      for (int x = 0; x < in.width(); ++x) out(x, y) += tap * from[static_cast<std::size_t>(x)];
    }
  });
  return out;
}

/// The masking signal at each pixel: the contrast common to both images, blurred and raised to a power.
OpponentPlanes make_masks(const Band& reference, const Band& test) {
  const double factor = ten_to(mask_decades);
  OpponentPlanes masks;
  for (std::size_t c = 0; c < reference.contrast.size(); ++c) {
    Plane<double> common = reference.contrast[c];
    for (std::size_t i = 0; i < common.values().size(); ++i) {
      common.values()[i] = std::min(std::abs(common.values()[i]), std::abs(test.contrast[c].values()[i]));
    }
    common = blurred(common);
    const SoftPower raise(mask_exponent[c]);
    for_rows(common.height(), [&](int y) {
      for (double& v : common.row(y)) v = raise(v * factor);
    });
    masks.push_back(std::move(common));
  }
  return masks;
}

/// The visible difference of one band, by channel.
std::vector<double> difference_in_band(const Band& reference, const Band& test, const Mask& is_ignored) {
  const OpponentPlanes masks = make_masks(reference, test);
  const SoftPower raise(difference_exponent);
  const double greatest = ten_to(max_difference_decades);
  const std::size_t count = masks.size();
  std::vector<double> out;
  for (std::size_t c = 0; c < count; ++c) {
    std::array<double, 4> weight{};
    for (std::size_t k = 0; k < count; ++k) weight[k] = natural_exp(mask_weight[k][c] * std::numbers::ln2);
    out.push_back(pooled(masks[0].width(), masks[0].height(), is_ignored, [&](int x, int y) {
      double mask = 0;
      for (std::size_t k = 0; k < count; ++k) mask += masks[k](x, y) * weight[k];
      const double d = raise(std::abs(test.contrast[c](x, y) - reference.contrast[c](x, y))) / (1 + mask);
      return greatest * d / (greatest + d);
    }));
  }
  return out;
}

double mean_of_plane(const Plane<double>& plane) {
  const double sum = sum_rows(plane.height(), [&](int y) {
    double row = 0;
    for (const double v : plane.row(y)) row += v;
    return row;
  });
  return sum / static_cast<double>(plane.values().size());
}

/// The difference of the pyramid's base band: contrast relative to the mean luminance, without masking.
std::vector<double> difference_in_baseband(const OpponentPlanes& reference, const OpponentPlanes& test,
                                           double frequency, const Mask& is_ignored) {
  const double expected = std::max(min_luminance, mean_of_plane(reference[0]));
  const double found = std::max(min_luminance, mean_of_plane(test[0]));
  std::vector<double> out;
  for (std::size_t c = 0; c < reference.size(); ++c) {
    const double weight = Sensitivity(static_cast<int>(c), frequency).at(expected) * ten_to(sensitivity_decibels / 20);
    const double whole = pooled(reference[c].width(), reference[c].height(), is_ignored, [&](int x, int y) {
      return std::abs(test[c](x, y) / found - reference[c](x, y) / expected) * weight;
    });
    out.push_back(whole * baseband_weight[c]);
  }
  return out;
}

OpponentPlanes reduced(const OpponentPlanes& planes) {
  OpponentPlanes out;
  for (const Plane<double>& plane : planes) out.push_back(reduce(plane));
  return out;
}

Mask reduced(const Mask& mask) {
  Mask out((mask.width() + 1) / 2, (mask.height() + 1) / 2);
  std::ranges::fill(out.values(), std::uint8_t{1});
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (mask(x, y) == 0) out(x / 2, y / 2) = 0;
  return out;
}

}  // namespace

std::vector<double> visible_difference(const OpponentPlanes& reference, const OpponentPlanes& test,
                                       const Viewing& viewing, Mask is_ignored) {
  const std::vector<double> frequencies =
      band_frequencies(reference[0].width(), reference[0].height(), viewing.pixels_per_degree);
  std::vector<std::vector<double>> bands(reference.size());
  OpponentPlanes a = reference, b = test;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    std::vector<double> differences;
    if (i + 1 == frequencies.size()) {
      differences = difference_in_baseband(a, b, frequencies[i], is_ignored);
    } else {
      OpponentPlanes a_below = reduced(a), b_below = reduced(b);
      const double factor = i == 0 ? 1 : 2;
      Band expected = make_band(a, a_below, factor), found = make_band(b, b_below, factor);
      weigh(expected, found, frequencies[i]);
      differences = difference_in_band(expected, found, is_ignored);
      a = std::move(a_below), b = std::move(b_below), is_ignored = reduced(is_ignored);
    }
    for (std::size_t c = 0; c < bands.size(); ++c) bands[c].push_back(differences[c] * channel_weight[c]);
  }
  std::vector<double> channels;
  for (const std::vector<double>& channel : bands) channels.push_back(norm(channel, 4));
  return channels;
}

double pool_channels(std::span<const double> channels) { return norm(channels, 4); }

double soft_root_mean_square(std::span<const double> values) {
  const SoftPower inner(2), outer(0.5);
  double sum = 0;
  for (const double value : values) sum += inner(value);
  return outer(sum / static_cast<double>(values.size()));
}

double quality_of(double difference) {
  if (difference > linear_below) return 10 - quality_factor * power(difference, quality_exponent);
  return 10 - quality_factor * power(linear_below, quality_exponent - 1) * difference;
}

double difference_of(double quality) {
  const double loss = (10 - quality) / quality_factor;
  const double at_bend = power(linear_below, quality_exponent);
  return loss > at_bend ? power(loss, 1 / quality_exponent) : loss * (linear_below / at_bend);
}

Metric cvvdp() {
  return {.name = "cvvdp",
          .summary = "ColorVideoVDP of a still: quality in JOD as people would judge it on a screen (10 is the same)",
          .source = "Mantiuk et al. 2024, version 0.5.6",
          .unit = "JOD",
          .better = Better::Higher,
          .perfect = 10.0,
          .is_default = false,
          .smallest = min_visible_size,
          .params = viewing_params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            // Fitted by the authors: a still has a smaller weight than a sequence.
            constexpr double still = 0.577918291091919;
            const Viewing viewing = viewing_of(settings);
            const std::vector<double> channels =
                visible_difference(opponent_planes(reference[0].linear, viewing),
                                   opponent_planes(test[0].linear, viewing), viewing, reference[0].is_ignored);
            return Score{.value = quality_of(pool_channels(channels) * still), .more = channel_figures(channels)};
          }};
}

}  // namespace zoneplate::metrics
