// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/flip/filters.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

constexpr double pi = std::numbers::pi;

Taps make_taps(int radius, const std::function<double(double)>& weight) {
  Taps taps;
  for (int i = -radius; i <= radius; ++i) taps.push_back(weight(i));
  return taps;
}

double sum_of(const Taps& taps) {
  double sum = 0;
  for (const double tap : taps) sum += tap;
  return sum;
}

void divide(Taps& taps, double by) {
  for (double& tap : taps) tap /= by;
}

/// Divides the positive taps by their sum, and the negative ones by the absolute value of theirs.
void normalize_parts(Taps& taps) {
  double positive = 0, negative = 0;
  for (const double tap : taps) (tap > 0 ? positive : negative) += tap;
  for (double& tap : taps) tap /= tap > 0 ? positive : -negative;
}

/// Contrast sensitivity in space, as a function of the distance in degrees: the transform of a Gaussian in frequency.
std::function<double(double)> sensitivity(double a, double b, double pixels_per_degree) {
  return [=](double i) {
    const double degrees = i / pixels_per_degree;
    return std::sqrt(a * std::sqrt(pi / b)) * natural_exp(-pi * pi * degrees * degrees / b);
  };
}

}  // namespace

FlipFilters make_flip_filters(double ppd) {
  FlipFilters f;

  // Three standard deviations of the broadest sensitivity, b = 0.04.
  f.color_radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  f.lightness = make_taps(f.color_radius, sensitivity(1, 0.0047, ppd));
  f.red_green = make_taps(f.color_radius, sensitivity(1, 0.0053, ppd));
  divide(f.lightness, sum_of(f.lightness));
  divide(f.red_green, sum_of(f.red_green));
  f.blue_yellow_narrow = make_taps(f.color_radius, sensitivity(34.1, 0.04, ppd));
  f.blue_yellow_broad = make_taps(f.color_radius, sensitivity(13.5, 0.025, ppd));
  const double narrow = sum_of(f.blue_yellow_narrow), broad = sum_of(f.blue_yellow_broad);
  const double both = std::sqrt(narrow * narrow + broad * broad);
  divide(f.blue_yellow_narrow, both);
  divide(f.blue_yellow_broad, both);

  // Edges and points with the width of greatest visibility, 0.082 degrees.
  const double sigma = 0.5 * 0.082 * ppd;
  f.feature_radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gaussian = [sigma](double x) { return natural_exp(-x * x / (2 * sigma * sigma)); };
  f.smooth = make_taps(f.feature_radius, gaussian);
  f.slope = make_taps(f.feature_radius, [&](double x) { return -x * gaussian(x); });
  f.bend = make_taps(f.feature_radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); });
  divide(f.smooth, sum_of(f.smooth));
  normalize_parts(f.slope);
  normalize_parts(f.bend);
  return f;
}

}  // namespace zoneplate::metrics
