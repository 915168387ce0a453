#pragma once

#include <functional>
#include <string>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/metrics/metric.h"

namespace zoneplate {
namespace ZONEPLATE_API metrics {

/// Pictures to compare, the i-th with the i-th; each is asked for once, in order, and let go when it has been judged.
struct Comparands {
  std::size_t count = 0;                                ///< the number of pairs
  std::function<Picture(std::size_t)> reference, test;  ///< make picture i of [0, count)
  bool are_frames = false;  ///< of one sequence: metrics that look at several frames have a meaning
};

/// What to do with a metric that cannot judge these pictures (too small, too few, nothing there to measure).
enum class Unfit {
  Leave,   ///< leave it out
  Refuse,  ///< ErrorKind::Input
};

/// One metric's answer.
struct Result {
  const Metric* metric = nullptr;  ///< a row of the catalogue, never null in a Comparison
  double value = 0;                ///< pooled over all pictures
  std::vector<double> values;      ///< of each picture, or of each run of `metric->frames` frames
  std::size_t worst = 0;           ///< the index of the worst of `values`
  Score score;                     ///< of the worst: its map, curves and further figures
};

/// The results of all metrics.
struct Comparison {
  bool are_same = true;         ///< every pair has the same codes, alpha included
  int width = 0, height = 0;    ///< pixels of the last test picture
  std::size_t count = 0;        ///< the number of pairs that were compared
  std::vector<Result> results;  ///< in the order of the choices, without those left out
};

/// Judges pictures by metrics.
///
/// Requires  count > 0.
/// Errors    ErrorKind::Input naming the picture's number and sizes where a metric wants other sizes; as Unfit says.
Comparison compare(const Comparands& pictures, std::span<const Choice> choices, Unfit unfit);

/// The metrics that are measured when the user names none.
std::vector<Choice> default_choices(std::span<const Metric> catalogue);

/// True where `value` is `threshold` or better.
bool is_as_good(const Metric& metric, double value, double threshold);

}  // namespace metrics
}  // namespace zoneplate
