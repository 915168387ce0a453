// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/metrics/metric.h"

#pragma GCC visibility push(default)
namespace zoneplate {
/// Image metrics: what they measure, by name, and comparisons of images.
namespace metrics {

/// The catalogue, in the order of metrics.txt.
std::span<const Metric> metrics();

}  // namespace metrics
}  // namespace zoneplate
#pragma GCC visibility pop
