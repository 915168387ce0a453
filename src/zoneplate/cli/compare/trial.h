#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::cli {

/// A square part of a picture, of `Place::side` pixels, by its upper left corner.
struct Place {
  static constexpr int side = 24;
  int x = 0, y = 0;
  double error = 0;  ///< mean FLIP there
};

/// One method's picture of one scene: what it cost, and how far it is from the reference.
struct Trial {
  std::string method;
  Rgba8Image picture;
  std::uint64_t pixels = 0;             ///< of the picture
  std::vector<double> frame_ms;         ///< of each turn, from the prepared scene to the codes
  std::vector<double> processor_ms;     ///< the same on all processors together, which other programs disturb less
  RenderCounts counts;                  ///< of the turn of least time
  std::optional<std::uint64_t> memory;  ///< bytes that the first turn needed more than was there before it
  std::vector<metrics::Result> results;
  Plane<float> error_map;  ///< FLIP
  std::vector<Place> worst;
  bool is_on_front = false;  ///< no other trial of the scene is both cheaper and nearer to the reference

  double least_ms() const;
  double least_processor_ms() const;
  double shaded_per_pixel() const;
  /// The value of a metric, or of a figure that it gives beside it ("edge_error.near_axis"); nothing where it could
  /// not be measured.
  std::optional<double> value(std::string_view name) const;
};

/// All of one scene.
struct SceneTrials {
  std::string scene;               ///< as given
  std::string name;                ///< of its folder
  std::string failure, complaint;  ///< where the scene says what it shows
  std::string reference;           ///< a method's text, or a file
  Rgba8Image reference_picture;
  std::optional<double> reference_ms;  ///< nothing of a file
  std::optional<double> reference_processor_ms;
  std::uint64_t reference_shaded = 0;
  int turns = 0;       ///< of each method, where they take no longer than the budget for them
  Place common_worst;  ///< where the methods are worst on average
  std::vector<Trial> trials;
};

/// How scenes are rendered and judged.
struct TrialOptions {
  std::vector<std::string> methods;
  std::string reference;
  bool is_reference_file = false;
  int turns = 3;
  std::vector<metrics::Choice> metrics;
};

/// A scene that is ready to be rendered.
struct TrialSetup {
  PreparedScene scene;
  Camera camera;
  RenderSettings settings;
};

/// Renders a scene by every method and by the reference, and judges them. `tell` is called with each method's text
/// before its turn.
///
/// The picture that is judged has 8 bits a channel, as it is written.
/// Errors    those of methods and files; ErrorKind::Input where the reference has another size.
SceneTrials run_trials(const TrialSetup& stage, const TrialOptions& options,
                       const std::function<void(const std::string&)>& tell);

/// The `count` squares with the greatest mean error, none overlapping another, the worst first.
std::vector<Place> worst_places(const Plane<float>& error, int count);

/// Marks the trials on the Pareto front of processor time and FLIP.
void find_front(std::vector<Trial>& trials);

}  // namespace zoneplate::cli
