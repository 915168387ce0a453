// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "zoneplate/metrics/metric.h"

#pragma GCC visibility push(default)
namespace zoneplate {
namespace metrics {

/// Pairs of images to compare; each is loaded once, in order, and released when it has been measured.
struct Comparands {
  std::size_t count = 0;                                    ///< the number of pairs
  std::function<Picture(std::size_t)> reference{}, test{};  ///< load image i of [0, count)
  bool are_frames = false;  ///< the images are frames of one sequence, so that metrics over several frames apply
  std::function<std::string(std::size_t)> name = {};  ///< of image i, for messages; none: "image 1" and so on
};

/// What to do with a metric that does not apply to the images (too small, too few, without the measured feature).
enum class Unfit {
  Leave,   ///< omit the metric
  Refuse,  ///< ErrorKind::Input
};

/// The result of one metric.
struct Result {
  const Metric* metric = nullptr;  ///< a row of the catalogue, never null in a Comparison
  double value = 0;                ///< pooled over all images
  std::vector<double> values{};    ///< of each image, or of each run of `metric->frames` frames with the feature
  std::size_t worst = 0;           ///< the index of the worst of `values`
  std::size_t worst_image = 0;     ///< the index of its image, of several frames the newest
  Score score{};                   ///< the map, curves and additional figures of the worst image
};

/// The results of all metrics.
struct Comparison {
  bool are_same = true;           ///< every pair has the same values (has_same_values)
  int width = 0, height = 0;      ///< in pixels, of the last test image
  std::size_t count = 0;          ///< the number of pairs that were compared
  std::vector<Result> results{};  ///< in the order of the choices, without omitted ones
};

/// Measures images with metrics.
///
/// Images with alpha are measured over black and over white, and the worse value counts, of each figure too; a metric
/// that says itself what alpha means (Metric::defines_alpha) is measured once. Values that are not finite are measured
/// as 0 (NaN) and ±65504 (infinities): count_not_finite (metrics/picture.h) finds them. Pixels that a reference ignores
/// (Picture::is_ignored) are not compared.
/// Requires  count > 0.
/// Errors    ErrorKind::Input naming the image's index and sizes if a metric requires other sizes; otherwise as in Unfit.
Comparison compare(const Comparands& pictures, std::span<const Choice> choices, Unfit unfit);

/// The metrics that are measured when the user names none.
std::vector<Choice> default_choices(std::span<const Metric> catalogue);

/// True where `value` is `threshold` or better.
bool is_as_good(const Metric& metric, double value, double threshold);

}  // namespace metrics
}  // namespace zoneplate
#pragma GCC visibility pop
