// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate::peers {

/// The parameters of a frame of a benchmark scene.
struct Work {
  int width = 1920, height = 1080, samples = 1, anisotropy = 1;
  float3 background;
};

/// Another software renderer with one benchmark scene uploaded.
///
/// One indexed mesh, one material: Blinn-Phong with one directional light and constant ambient, or unlit; one texture
/// with trilinear filtering; straight alpha blended over. Other properties of the scene's material are ignored.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Draws a frame and reads it back into memory.
  virtual void frame() = 0;
  /// The last frame, row 0 at the top.
  virtual Rgba8Image picture() const = 0;
  /// The API, the driver and its version, for example "OpenGL 4.5 (Core Profile) Mesa 25.0.7-2".
  virtual const std::string& version() const = 0;
};

/// llvmpipe, Mesa's software OpenGL, through OSMesa.
///
/// Errors    ErrorKind::Failed: there is no OSMesa, or it does not support the work.
std::unique_ptr<Peer> make_llvmpipe(const Scene& scene, const Work& work);
/// lavapipe, Mesa's software Vulkan, or the software Vulkan driver that VK_ICD_FILENAMES names.
///
/// Errors    ErrorKind::Failed: there is no Vulkan driver for the processor, or it does not support the work.
std::unique_ptr<Peer> make_lavapipe(const Scene& scene, const Work& work);

}  // namespace zoneplate::peers
