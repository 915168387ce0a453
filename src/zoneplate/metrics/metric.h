#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

enum class Better { Lower, Higher };

/// The sizes of the two images that a metric requires.
enum class Sizes {
  Same,              ///< equal
  ReferenceMultiple  ///< the reference is n × n times as large, n = 1, 2, 3, ...
};

/// An additional number of a metric.
struct Figure {
  std::string name;
  double value = 0;
  std::string unit;
};

/// A function that was measured: a response, a spectrum.
struct Curve {
  std::string name, x_label, y_label;
  std::vector<double> x, y;
};

/// The result of a metric for one image (or for the consecutive frames that it uses together).
struct Score {
  double value = 0;
  std::vector<Figure> more;
  std::vector<Curve> curves;
  Plane<float> map;  ///< the error at each pixel, from 0 (none) to 1; empty if the metric has no map
};

using Frames = std::span<const Picture>;

/// The mean, for metrics whose values add: how most of them pool the frames of a sequence.
double mean_of(std::span<const double> values);
double root_mean_square_of(std::span<const double> values);

/// An entry of the catalogue; each metric's file defines its own.
struct Metric {
  std::string_view name, summary, source, unit;
  Better better = Better::Lower;
  std::optional<double> perfect = 0.0;  ///< the value for identical images, if there is one
  bool is_default = true;               ///< measured if the user names no metric
  int frames = 1;                       ///< number of consecutive frames that are used together
  bool starts_short = false;            ///< the first images are measured too, with fewer frames
  int smallest = 1;                     ///< least width and height
  Sizes sizes = Sizes::Same;
  std::span<const Param> params = {};
  /// Requires  `frames` images each (fewer if starts_short), of the sizes that `sizes` and `smallest` require. Nothing if
  /// the images lack the measured feature.
  std::function<std::optional<Score>(Frames reference, Frames test, const Settings&)> measure;
  double (*pool)(std::span<const double> values) = mean_of;  ///< of a sequence's scores
};

/// A metric with its settings.
struct Choice {
  const Metric* metric = nullptr;
  Settings settings;
};

/// Reads a text such as `flip:ppd=30`.
///
/// Errors    ErrorKind::Usage naming an unknown metric, parameter or value, with the closest one or all of them.
Choice choose_metric(std::span<const Metric> catalogue, std::string_view text);

}  // namespace zoneplate::metrics
