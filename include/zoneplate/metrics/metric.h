#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/metrics/picture.h"

namespace zoneplate {
namespace ZONEPLATE_API metrics {

/// Which values of a metric are better.
enum class Better {
  Lower,   ///< an error or a distance
  Higher,  ///< a similarity or a signal-to-noise ratio
};

/// What a metric wants of the sizes of the two pictures.
enum class Sizes {
  Same,              ///< equal
  ReferenceMultiple  ///< the reference is n × n times as large, n = 1, 2, 3, ...
};

/// A number beside a metric's own.
struct Figure {
  std::string name;  ///< as in reports: "rmse"
  double value = 0;  ///< in `unit`
  std::string unit;  ///< "code", "share of pixels"; empty for a ratio
};

/// A function that was measured: a response, a spectrum.
struct Curve {
  std::string name, x_label, y_label;  ///< for legends and axes of a plot
  std::vector<double> x, y;            ///< of the points, in order of x
};

/// What a metric says of a picture (or of as many consecutive frames as it looks at).
struct Score {
  double value = 0;           ///< in the unit of the metric
  std::vector<Figure> more;   ///< other values that the measurement gives
  std::vector<Curve> curves;  ///< for metrics that measure a function
  Plane<float> map;  ///< the error at each pixel, 0 none to 1 greatest; empty where the metric has no such thing
};

using Frames = std::span<const Picture>;  ///< consecutive pictures of a sequence, the newest last

/// The mean, for metrics whose values add: how most of them pool the frames of a sequence.
double mean_of(std::span<const double> values);
/// The square root of the mean of the squares, for metrics that are such roots themselves.
double root_mean_square_of(std::span<const double> values);

/// A row of the catalogue; each metric's file makes its own.
struct Metric {
  std::string_view name;                ///< in lower case: "flip" of `flip:ppd=30`
  std::string_view summary;             ///< one line for listings
  std::string_view source;              ///< the publication or standard that defines the metric
  std::string_view unit;                ///< "dB"; empty for a pure number
  Better better = Better::Lower;        ///< decides which of several values is the worst
  std::optional<double> perfect = 0.0;  ///< the value of a picture judged against itself, where there is one
  bool is_default = true;               ///< measured when the user names no metric
  int frames = 1;                       ///< consecutive frames looked at together
  bool starts_short = false;            ///< the first pictures are judged too, with as many frames as there are
  int smallest = 1;                     ///< least width and height
  Sizes sizes = Sizes::Same;            ///< required of reference and test
  std::span<const Param> params = {};   ///< what may follow the name: ppd of `flip:ppd=30`
  /// Measures the newest test picture against its reference.
  /// Requires  `frames` pictures each (fewer where it starts short), of sizes as asked above. Nothing where the picture
  /// has not what is measured.
  std::function<std::optional<Score>(Frames reference, Frames test, const Settings&)> measure;
  double (*pool)(std::span<const double> values) = mean_of;  ///< of a sequence's scores
};

/// A metric with its settings, ready to measure.
struct Choice {
  const Metric* metric = nullptr;  ///< a row of the catalogue
  Settings settings;               ///< the values of its parameters
};

/// Reads a text such as `flip:ppd=30`.
///
/// Errors    ErrorKind::Usage naming an unknown metric, parameter or value, and the closest or what there is.
Choice choose_metric(std::span<const Metric> catalogue, std::string_view text);

}  // namespace metrics
}  // namespace zoneplate
