// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/evaluate/dataset/camera_path.h"
#include "zoneplate/evaluate/dataset/sequence.h"
#include "zoneplate/render/method.h"
#include "zoneplate/render/sequence.h"

namespace zoneplate {

/// The scenes and the cameras of a sequence.
class Shots {
 public:
  /// `source` is that of the sequence's scene, and outlives this object, as `sequence` does.
  Shots(const DatasetSequence& sequence, SceneSource& source);

  SceneView view(int frame);
  Camera camera(int frame) { return moved(frames_.moment(frame).camera, frame); }
  /// Of the first frame, in seconds of the scene's animation.
  double start() const { return start_; }

 private:
  Scene at(double seconds);
  Sequence frames_of();
  Camera moved(const Camera& camera, int frame) const;

  const DatasetSequence& sequence_;
  SceneSource& source_;
  CameraPath path_;
  SceneChoice choice_;
  double start_ = 0;
  Sequence frames_;
  float distance_ = 1;
};

/// The data of the nearest surface at 16 samples of each pixel.
std::unique_ptr<Resolver> nearest_of_sixteen();

}  // namespace zoneplate
