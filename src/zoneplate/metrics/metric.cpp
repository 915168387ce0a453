// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/metric.h"

#include <cmath>

namespace zoneplate::metrics {
double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double root_mean_square_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

Choice choose_metric(std::span<const Metric> catalogue, std::string_view text) {
  const auto [metric, settings] = parse_spec("metric", catalogue, text);
  return {&metric, settings};
}

}  // namespace zoneplate::metrics
