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

enum class Better { Lower, Higher };

/// What a metric wants of the sizes of the two pictures.
enum class Sizes {
  Same,              ///< equal
  ReferenceMultiple  ///< the reference is n × n times as large, n = 1, 2, 3, ...
};

/// A number beside a metric's own.
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

/// What a metric says of a picture (or of as many consecutive frames as it looks at).
struct Score {
  double value = 0;
  std::vector<Figure> more;
  std::vector<Curve> curves;
  Plane<float> map;  ///< the error at each pixel, 0 none to 1 greatest; empty where the metric has no such thing
};

using Frames = std::span<const Picture>;

/// The mean, for metrics whose values add: how most of them pool the frames of a sequence.
double mean_of(std::span<const double> values);
double root_mean_square_of(std::span<const double> values);

/// A row of the catalogue; each metric's file makes its own.
struct Metric {
  std::string_view name, summary, source, unit;
  Better better = Better::Lower;
  std::optional<double> perfect = 0.0;  ///< the value of a picture judged against itself, where there is one
  bool is_default = true;               ///< measured when the user names no metric
  int frames = 1;                       ///< consecutive frames looked at together
  bool starts_short = false;            ///< the first pictures are judged too, with as many frames as there are
  int smallest = 1;                     ///< least width and height
  Sizes sizes = Sizes::Same;
  std::span<const Param> params = {};
  /// Requires  `frames` pictures each (fewer where it starts short), of sizes as asked above. Nothing where the picture
  /// has not what is measured.
  std::function<std::optional<Score>(Frames reference, Frames test, const Settings&)> measure;
  double (*pool)(std::span<const double> values) = mean_of;  ///< of a sequence's scores
};

/// A metric with its settings, ready to measure.
struct Choice {
  const Metric* metric = nullptr;
  Settings settings;
};

/// Reads a text such as `flip:ppd=30`.
///
/// Errors    ErrorKind::Usage naming an unknown metric, parameter or value, and the closest or what there is.
Choice choose_metric(std::span<const Metric> catalogue, std::string_view text);

}  // namespace metrics
}  // namespace zoneplate
