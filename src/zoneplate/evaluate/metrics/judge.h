// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/file/picture_set.h"
#include "zoneplate/metrics/ignored.h"
#include "zoneplate/report/html_page.h"

namespace zoneplate {

/// A value that a metric must reach.
struct Bound {
  const metrics::Metric* metric = nullptr;
  std::string figure;  ///< one of the metric's additional figures ("max" of mae); empty: its value
  double value = 0;
};

/// The test images that the renderer could not make, by their names, with the causes.
using FailedRenders = std::map<std::string, std::string>;

/// What decides whether images pass.
struct Verdicts {
  std::vector<Bound> bounds;          ///< none: images pass if they are identical
  bool judges_mean = false;           ///< the bounds hold for the pooled values of all images, not for each image
  bool allows_unpaired = false;       ///< an image that only one side has does not fail
  bool refuses_unfit = false;         ///< an image that a metric cannot measure fails
  FailedRenders failed_renders = {};  ///< these fail, whether or not there is a file or a reference of their name
  metrics::IgnoredRegions ignored = {};
  std::vector<std::string> ignored_texts = {};  ///< as they were given
};

enum class PairOutcome {
  Passed,
  Failed,   ///< it differs, misses a bound, or has another size than its reference
  Missing,  ///< there is a reference, but no test image
  New,      ///< there is a test image, but no reference
  Unreadable,
  NotRendered,  ///< the renderer reports that it could not make the test image
};

/// The images of a pair for the report. Pictures that do not exist have no bytes.
struct Evidence {
  PagePicture reference, test, errors;
  std::string error_name, error_text;  ///< the metric of the error map, and its value: "flip 0.123"
  bool is_left_out = false;            ///< the evidence of all pairs has reached its greatest size
};

/// What was found out about one pair of images.
struct JudgedItem {
  std::string name;
  PairOutcome outcome = PairOutcome::Passed;
  std::string message;                                      ///< why it failed
  metrics::StoredDifference stored{.is_identical = false};  ///< what the metrics do not say
  double seconds = 0;
  int width = 0, height = 0;             ///< of the test image; 0 if it was not measured
  std::vector<metrics::Result> results;  ///< without maps
  Evidence evidence;                     ///< only if it was requested

  bool passed() const { return outcome == PairOutcome::Passed; }
  bool is_identical() const { return stored.is_identical; }
};

/// The value of one metric over all images that it measured.
struct PooledResult {
  const metrics::Metric* metric = nullptr;
  double value = 0;
  std::vector<double> values;      ///< of each measured image, or of each run of frames
  std::vector<std::size_t> items;  ///< the items of `values`; empty for metrics of several frames
  std::size_t worst = 0;           ///< index of the worst of `values`
  std::size_t worst_image = 0;     ///< of metrics of several frames, the index of the newest of its frames
  metrics::Score score;            ///< of the worst image, without its map
};

struct Judgement {
  std::vector<JudgedItem> items;
  std::vector<std::string> ignored;       ///< regions, as they were given
  std::vector<std::string> not_compared;  ///< files of the directories, in formats that are not read there
  bool is_sequence = false;               ///< the items are frames of equal size
  std::vector<PooledResult> pooled;
  std::string pooled_message;  ///< which pooled value misses its bound; empty if none does
  /// The error map of the worst image by the first metric that has one, and its reference.
  std::optional<Plane<float>> worst_map;
  std::optional<DisplayImage> worst_reference;

  std::size_t failures() const;
  bool passed() const { return failures() == 0 && pooled_message.empty(); }
  bool is_identical() const;
};

/// Compares every pair of images, one after the other. A pair that cannot be compared fails alone.
///
/// `keeps_evidence`: of failed pairs, of a single pair, and of the frames of sequences. `progress(done)` is called with
/// the fraction of completed pairs.
Judgement judge(const metrics::PictureSet& reference, const metrics::PictureSet& test,
                const std::vector<metrics::Choice>& choices, const Verdicts& verdicts, bool keeps_evidence,
                const std::function<void(double)>& progress);

/// "R, G, B in 64 pixels; Z in 3 pixels".
std::string text_of(const std::vector<metrics::ChannelCount>& counts);

/// A number with six digits; infinities are "inf" and "-inf".
std::string number_text(double value);

/// The error map over its reference in grey: `map` is multiplied by `gain`, painted in magma, and covers the reference
/// where the error is great.
Rgba8Image paint_over(const Plane<float>& map, const DisplayImage& reference, float gain);

}  // namespace zoneplate
