// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/render/lighting.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {
class TextureSet;
class InterleavedVertices;
}  // namespace zoneplate

#pragma GCC visibility push(default)
namespace zoneplate {

/// A scene with the data that rendering derives from it once: texture mip levels and vertex buffers. Data that depend
/// on the lights or the camera are made for each frame. The lights are those of the scene, or of `lit`: no default
/// lights are added (see light_unlit).
///
/// Copies share the data, which are immutable. Several threads may use one copy.
class PreparedScene {
 public:
  /// Makes texture levels and vertex buffers, on the threads of the innermost `with_threads`. With `raw_colors` the
  /// values of images are taken as linear, not decoded from sRGB. The images of the scene are freed as soon as their
  /// levels are made.
  ///
  /// Requires  a scene that meets the requirements of Scene.
  /// Errors    ErrorKind::Input where an image that a material uses is empty; OutOfMemory.
  explicit PreparedScene(Scene scene, bool raw_colors = false);

  /// The same scene at another moment: it shares the texture levels of `other` and makes its own vertex buffers.
  ///
  /// Requires  the materials use the same images as those of `other`.
  PreparedScene(Scene scene, const PreparedScene& other);

  /// The same scene under other lights. An environment with an image and without a map gets the map of the scene's own
  /// environment, and its mean radiance as ambient light where there is none.
  ///
  /// Requires  such an image is that of the scene's own environment.
  PreparedScene lit(Lighting lighting) const;

  /// The scene without the texels of its images. Its lighting is `lighting()`.
  const Scene& scene() const { return *scene_; }
  /// The same object as `scene`, for those that outlive this PreparedScene.
  std::shared_ptr<const Scene> shared_scene() const { return scene_; }
  /// The lights that frames are rendered with.
  const Lighting& lighting() const { return lighting_; }
  ///@{
  /// What backends render from. The types are not part of the public headers.
  const TextureSet& textures() const { return *textures_; }
  const InterleavedVertices& vertices() const { return *vertices_; }
  ///@}

 private:
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const TextureSet> textures_;
  std::shared_ptr<const InterleavedVertices> vertices_;
  Lighting lighting_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
