// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "zoneplate/image/rgb.h"
#include "zoneplate/metrics/metric.h"

#pragma GCC visibility push(default)
namespace zoneplate {
/// Image metrics: what they measure, by name, and comparisons of images.
namespace metrics {

/// The catalogue, in the order of metrics.txt.
std::span<const Metric> metrics();

/// The value of a metric for two images: `measure(reference, test, "flip")`, or with parameters "flip:ppd=30".
///
/// Images with alpha are measured as by `compare`.
/// Errors    ErrorKind::Usage naming an unknown metric; ErrorKind::Input where it does not apply to the images, such as
///           to different sizes, and for metrics of several frames.
double measure(const Rgba8Image& reference, const Rgba8Image& test, std::string_view metric);

}  // namespace metrics
}  // namespace zoneplate
#pragma GCC visibility pop
