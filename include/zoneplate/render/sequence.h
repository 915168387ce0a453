// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The timing of a sequence. Frame i has the time start + i / rate seconds.
struct SequenceTiming {
  double rate = 24;     ///< frames per second
  double start = 0;     ///< seconds
  double duration = 0;  ///< of the animation, in seconds
  std::optional<int>
      turntable{};  ///< frames of one turn of the camera about the centre of the scene; none: no turntable
};

/// Functions that make the scene at a time in seconds.
struct SceneLoader {
  std::function<Scene(double)> load{};        ///< the whole scene at a time
  std::function<Scene(double)> load_shape{};  ///< the same without images
  /// Times, in seconds, that a camera of the whole animation has to see, the most important first: those of keys. Empty
  /// if they are not known.
  std::function<std::vector<double>()> key_times = {};
};

/// The scenes and cameras of a sequence of frames. Frames are numbered from 0; fractional frame numbers are allowed.
///
/// The camera of a whole-scene view is fixed and frames the whole animation, whichever frames are rendered: what it
/// sees of at most 256 moments, fewer of large scenes: evenly spaced ones, the loader's key times and the times of
/// frames. Its near and far planes enclose the scene of each frame. A camera of the scene follows its own animation. On
/// a turntable of n frames the camera has turned by i / n of a revolution about the centre of the scene at frame i.
class Sequence {
 public:
  /// A static scene; only the camera may move.
  Sequence(PreparedScene scene, const SequenceTiming& timing);
  /// An animated scene, which is loaded again for each frame.
  Sequence(SceneLoader loader, const MipOptions& mips, const SequenceTiming& timing);

  /// Chooses the camera of frame 0, for images of this aspect ratio (width / height). Must be called before functions
  /// that use the camera.
  ///
  /// Errors    those of choose_camera.
  void set_view(const View& view, float aspect);

  /// The camera of each frame is that of a view of its own, `view_at(frame)`, in place of set_view and a turntable. Of
  /// a whole-scene view it frames the whole animation.
  ///
  /// Errors    those of choose_camera, here and later.
  void set_views(std::function<View(double)> view_at, float aspect);

  /// The time of a frame, in seconds of the animation.
  double seconds_of(double frame) const { return timing_.start + frame / timing_.rate; }

  /// The prepared scene at a frame. Textures are made once for all frames; the last scene is cached.
  const PreparedScene& scene(double frame);
  /// The scene at a frame and the camera then, for Renderer.
  SceneView view(double frame);
  /// The geometry and the camera of the scene at a frame, for Frame::motion and Frame::flow. Does not replace the
  /// cached scene.
  Moment moment(double frame);

 private:
  Camera camera(const Scene& scene, double frame) const;
  bool is_seen_from_all_sides() const;
  std::vector<double> pose_times() const;
  Scene all_poses() const;
  float4x4 turned(float angle) const;
  void add_turns(Scene& all) const;

  SceneLoader loader_;  ///< empty for a static scene
  MipOptions mips_;
  SequenceTiming timing_;
  std::optional<PreparedScene> scene_;
  double frame_ = 0;  ///< of `scene_`
  View view_;
  std::function<View(double)> view_at_;  ///< empty: `view_` of all frames
  Scene poses_;                          ///< of an animated scene with `view_at_`: all of them
  float aspect_ = 1;
  Camera still_;  ///< before the turntable turns it
  float3 centre_;
};

/// The weight of a moment in a frame, as a function of time. All filters have their middle at the middle of the box,
/// and its width at half their height; the triangle is twice as wide.
enum class ShutterFilter {
  Box,       ///< an open shutter
  Triangle,  ///< the box twice: frequencies at which the box has its zeros are damped by their square
  Gaussian,  ///< cut off at four standard deviations
};

/// The time, as a frame number, of sample i of `count` of a shutter that opens at the frame's time and stays open for
/// the fraction `open` of the frame interval. Samples lie at the middle of `count` parts of the filter of equal weight:
/// their mean is the filtered moment.
double shutter_time(double frame, double open, int i, int count, ShutterFilter filter = ShutterFilter::Box);

}  // namespace zoneplate
#pragma GCC visibility pop
