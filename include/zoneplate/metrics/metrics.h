// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/base/api.h"
#include "zoneplate/metrics/metric.h"

namespace zoneplate {
/// Image metrics: what they measure, by name, and comparisons of images.
namespace ZONEPLATE_API metrics {

/// The catalogue, in the order of metrics.txt.
std::span<const Metric> metrics();

}  // namespace metrics
}  // namespace zoneplate
