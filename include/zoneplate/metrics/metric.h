// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/metrics/picture.h"

#pragma GCC visibility push(default)
namespace zoneplate {
namespace metrics {

/// Which values of a metric are better.
enum class Better {
  Lower,   ///< an error or a distance
  Higher,  ///< a similarity or a signal-to-noise ratio
};

/// The sizes of the two images that a metric requires.
enum class Sizes {
  Same,              ///< equal
  ReferenceMultiple  ///< the reference is n × n times as large, n = 1, 2, 3, ...
};

/// An additional number of a metric.
struct Figure {
  std::string name{};  ///< as in reports: "rmse"
  double value = 0;    ///< in `unit`
  std::string unit{};  ///< "code", "share of pixels"; empty for a ratio
};

/// A function that was measured: a response, a spectrum.
struct Curve {
  std::string name{}, x_label{}, y_label{};  ///< for legends and axes of a plot
  std::vector<double> x{}, y{};              ///< of the points, in order of x
};

/// The result of a metric for one image (or for the consecutive frames that it uses together).
struct Score {
  double value = 0;             ///< in the unit of the metric
  std::vector<Figure> more{};   ///< other values that the measurement gives
  std::vector<Curve> curves{};  ///< for metrics that measure a function
  Plane<float> map{};           ///< the error at each pixel, from 0 (none) to 1; empty if the metric has no map
};

using Frames = std::span<const Picture>;  ///< consecutive images of a sequence, the newest last

/// The mean, for metrics whose values add: how most of them pool the frames of a sequence.
double mean_of(std::span<const double> values);
/// The square root of the mean of the squares, for metrics that are such roots themselves.
double root_mean_square_of(std::span<const double> values);

/// An entry of the catalogue; each metric's file defines its own.
struct Metric {
  std::string_view name{};              ///< in lower case: "flip" of `flip:ppd=30`
  std::string_view summary{};           ///< one line for listings
  std::string_view source{};            ///< the publication or standard that defines the metric
  std::string_view unit{};              ///< "dB"; empty for a pure number
  Better better = Better::Lower;        ///< decides which of several values is the worst
  std::optional<double> perfect = 0.0;  ///< the value for identical images, if there is one
  /// True if it says itself what alpha means; null: the worse of the values over black and over white counts.
  bool (*defines_alpha)(const Settings&) = nullptr;
  bool is_default = true;              ///< measured if the user names no metric
  int frames = 1;                      ///< number of consecutive frames that are used together
  bool starts_short = false;           ///< the first images are measured too, with fewer frames
  bool needs_whole_image = false;      ///< ignored pixels cannot be left out, such as of a spectrum
  int smallest = 1;                    ///< least width and height
  Sizes sizes = Sizes::Same;           ///< required of reference and test
  std::span<const Param> params = {};  ///< what may follow the name: ppd of `flip:ppd=30`
  /// Measures the newest test image against its reference.
  /// Requires  `frames` images each (fewer if starts_short), of the sizes that `sizes` and `smallest` require. Nothing if
  /// the images lack the measured feature; of a sequence, the other windows are measured.
  std::function<std::optional<Score>(Frames reference, Frames test, const Settings&)> measure{};
  double (*pool)(std::span<const double> values) = mean_of;  ///< of a sequence's scores
};

/// A metric with its settings.
struct Choice {
  const Metric* metric = nullptr;  ///< a row of the catalogue
  Settings settings{};             ///< the values of its parameters
};

/// Reads a text such as `flip:ppd=30`.
///
/// Errors    ErrorKind::Usage naming an unknown metric, parameter or value, with the closest one or all of them.
Choice choose_metric(std::span<const Metric> catalogue, std::string_view text);

}  // namespace metrics
}  // namespace zoneplate
#pragma GCC visibility pop
