#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"

namespace zoneplate {

/// The time of a sequence. Frame i shows the scene at start + i / rate seconds.
struct SequenceTiming {
  double rate = 24;              ///< frames per second
  double start = 0;              ///< seconds
  double duration = 0;           ///< of the animation, in seconds
  std::optional<int> turntable;  ///< frames of one turn of the camera about the centre of the scene; none: it stands
};

/// Makes the scene at a time in seconds.
struct SceneLoader {
  std::function<Scene(double)> load;
  std::function<Scene(double)> load_shape;  ///< the same without images
};

/// The scenes and cameras of a sequence of frames, which are numbered from 0 and may lie between two numbers.
///
/// The camera of a whole-scene view stands so that it sees the whole animation, whichever frames are rendered, and
/// stays there. A camera of the scene moves as its animation says. On a turntable of n frames the camera has gone i / n
/// of a turn about the centre of the scene at frame i.
class Sequence {
 public:
  /// A scene that does not move; only the camera does.
  Sequence(PreparedScene scene, const SequenceTiming& timing);
  /// An animated scene, which is loaded for each frame.
  Sequence(SceneLoader loader, bool raw_colors, const SequenceTiming& timing);

  /// Chooses the camera of frame 0, for pictures of this aspect (width / height). Must be called before any
  /// function that uses the camera.
  ///
  /// Errors    those of choose_camera.
  void set_view(const View& view, float aspect);

  double seconds_of(double frame) const { return timing_.start + frame / timing_.rate; }

  /// The scene at a frame, with its textures, which are made once, and its vertices. The last one is kept.
  const PreparedScene& scene(double frame);
  SceneView view(double frame);
  /// The shape of the scene at a frame, and the camera then: what Frame::motion and Frame::flow are counted from. The
  /// scene of `scene` stays.
  Moment moment(double frame);

 private:
  Camera camera(const Scene& scene, double frame) const;
  Scene all_poses();
  float4x4 turned(float angle) const;
  void add_turns(Scene& all) const;

  SceneLoader loader_;  ///< empty where the scene does not move
  bool raw_colors_ = false;
  SequenceTiming timing_;
  std::optional<PreparedScene> scene_;
  double frame_ = 0;  ///< of `scene_`
  View view_;
  float aspect_ = 1;
  Camera still_;  ///< before the turntable turns it
  float3 centre_;
};

/// The time of sample i of `count` within a frame whose shutter is open from the frame's own time on, for `open` of the
/// time between two frames: the middle of its part.
double shutter_time(double frame, double open, int i, int count);

}  // namespace zoneplate
