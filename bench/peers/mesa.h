// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate::peers {

/// What a frame of a benchmark scene is asked for.
struct Work {
  int width = 1920, height = 1080, samples = 1, anisotropy = 1;
  float3 background;
};

/// Mesa's software OpenGL (llvmpipe, through OSMesa) with one benchmark scene ready to be drawn.
///
/// One indexed mesh, one material: Blinn-Phong with one directional light and constant ambient, or unlit; one texture
/// with trilinear filtering; straight alpha laid over. What the scene's material cannot say in these words is not
/// drawn.
class Mesa {
 public:
  /// Errors    ErrorKind::Failed: there is no OSMesa, or it cannot do what is asked.
  Mesa(const Scene& scene, const Work& work);
  ~Mesa();
  Mesa(const Mesa&) = delete;
  Mesa& operator=(const Mesa&) = delete;

  /// Draws a frame and reads it back into memory.
  void frame();
  /// The last frame, row 0 at the top.
  Rgba8Image picture() const;
  /// What OpenGL says of itself, for example "4.5 (Core Profile) Mesa 25.0.7-2".
  const std::string& version() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace zoneplate::peers
