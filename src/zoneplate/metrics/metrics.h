#pragma once

#include <span>

#include "zoneplate/metrics/metric.h"

namespace zoneplate::metrics {

/// The catalogue, in the order of metrics.txt.
std::span<const Metric> metrics();

}  // namespace zoneplate::metrics
