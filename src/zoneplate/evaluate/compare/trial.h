// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/ignored.h"
#include "zoneplate/os/usage.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate {

/// A square region of an image with sides of `Place::side` pixels, given by its upper left corner.
struct Place {
  static constexpr int side = 24;
  int x = 0, y = 0;
  double error = 0;  ///< mean FLIP of the region
};

/// One method's image of one scene, with its cost and its error against the reference.
struct Trial {
  std::string method;
  Rgba8Image picture;            ///< of a sequence, its last frame
  std::vector<Rgba8Image> film;  ///< the frames of a sequence; of a still image, empty
  std::uint64_t pixels = 0;      ///< of the image
  bool is_sequence = false;
  /// Frames that `counts` sums: of a sequence all, of a still image those in which a method with history settles.
  int frames = 1;
  std::vector<double> frame_ms;      ///< of a frame, from the prepared scene to the 8-bit image: by turn, or by frame
  std::vector<double> processor_ms;  ///< CPU time of all threads, which other programs affect less
  RenderCounts counts;               ///< of the fastest turn, or of the sequence
  std::optional<std::uint64_t> memory;  ///< increase of resident memory in the first turn, bytes
  std::vector<metrics::Result> results;
  Plane<float> error_map;  ///< FLIP
  std::vector<Place> worst;
  bool is_on_front = false;  ///< no other trial of the scene has both less CPU time and a better value

  /// The times of a frame: the least of the turns, which are the same work; of a sequence the median of its frames.
  double ms() const;
  double cpu_ms() const;
  /// Means over the frames.
  double shaded() const { return static_cast<double>(counts.shaded) / frames; }
  double shaded_per_pixel() const { return shaded() / static_cast<double>(pixels); }
  /// The value of a metric, or of one of its additional figures ("edge_error.near_axis"); nothing if it could not be
  /// measured.
  std::optional<double> value(std::string_view name) const;
};

/// The trials of one scene.
struct SceneTrials {
  std::string scene;               ///< a file or a built-in scene
  std::string name;                ///< name of its folder
  std::string failure, complaint;  ///< the class of artifacts that a built-in scene shows, and its description
  std::string reference;           ///< a method's text, or a file
  Rgba8Image reference_picture;
  std::vector<Rgba8Image> reference_film;
  std::vector<Plane<std::uint8_t>> uncovered;  ///< by frame: Picture::is_uncovered; empty if no metric uses it
  std::optional<Trial> reference_cost;         ///< without its image; nothing for a file
  /// Root mean square over the pixels of its own estimate of its error, in linear light; nothing if it has none.
  std::optional<double> reference_error;
  const metrics::Metric* ranking = nullptr;  ///< the first metric of the options
  int turns = 0;                             ///< turns of each method, if its time budget suffices
  metrics::IgnoredRegions ignored;           ///< not measured
  std::vector<std::string> ignored_texts;    ///< the same as the command states it
  Place common_worst;                        ///< the region of the greatest mean error over all methods
  std::vector<Trial> trials;
};

/// The options of rendering and measuring scenes.
struct TrialOptions {
  std::vector<std::string> methods;
  std::string reference;
  bool is_reference_file = false;
  int turns = 3;
  std::vector<metrics::Choice> metrics;  ///< the first one ranks
  metrics::IgnoredRegions ignored = {};
  std::vector<std::string> ignored_texts = {};
};

/// A scene ready for rendering.
struct TrialSetup {
  PreparedScene scene;
  Camera camera;
  RenderSettings settings;
  const MemoryFiles& memory;
  int frames = 1;                           ///< more than 1: a sequence, of which every frame is rendered and measured
  std::function<SceneView(int)> view = {};  ///< of a sequence: its frames
  std::function<metrics::Picture()> load_reference = {};  ///< where the reference is a file
};

/// Frames of a sequence in a second.
constexpr double trial_frame_rate = 24;

/// Begins a method, and returns the function to which its progress from 0 to 1 is reported, by any thread.
using TrialProgress = std::function<std::function<void(double)>(const std::string& method)>;

/// Renders a scene with every method and the reference, and measures the methods. `progress` is called with each
/// method's text before it is rendered, and its result with the fraction of the method's frames that is complete.
///
/// The metrics are applied to the 8-bit images that are written; of a sequence, to all of its frames, and the error map
/// is that of the last frame.
/// Errors    those of methods and files; ErrorKind::Input if the reference has another size.
SceneTrials run_trials(const TrialSetup& stage, const TrialOptions& options, const TrialProgress& progress);

/// The FLIP error map of an image.
Plane<float> flip_map(const Rgba8Image& reference, const Rgba8Image& test, const metrics::IgnoredRegions& ignored);

/// The `count` squares with the greatest mean errors that do not overlap, in descending order.
std::vector<Place> worst_places(const Plane<float>& error, int count);

/// True if one value of a metric is better than another; any is better than none.
bool is_better(const metrics::Metric& metric, std::optional<double> a, std::optional<double> b);

/// True if no other point has both less CPU time and a better value, one of them strictly.
struct CostPoint {
  double cpu_ms = 0;
  std::optional<double> value;
};
bool is_on_front(const CostPoint& own, std::span<const CostPoint> all, const metrics::Metric& metric);

/// Marks the trials on the Pareto front of CPU time and a metric.
void mark_front(std::vector<Trial>& trials, const metrics::Metric& metric);

}  // namespace zoneplate
