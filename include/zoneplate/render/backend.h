// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/render/render.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A device that renders frames. Everything above it (antialiasing methods, Renderer, the command) describes a frame by
/// a Request and receives its planes in a Frame, so that neither depends on the device.
///
/// A backend is used by one thread at a time. It may keep data that consecutive frames share: memory, or copies of a
/// PreparedScene, whose `shared_scene()` is the same object as long as nothing of it changes.
class Backend {
 public:
  virtual ~Backend() = default;

  /// Renders one frame of a scene by a request; `counts`, if not null, receives the time and the work.
  ///
  /// Exact     the bits of make_cpu_backend().
  /// Errors    ErrorKind::Usage for a size, crop or combination of planes that cannot be rendered; OutOfMemory.
  virtual Frame render(const PreparedScene& scene, const Camera& camera, const Request& request,
                       const RenderOptions& options, RenderCounts* counts) = 0;

  /// Accepts an image whose memory the next frame may use for Frame::display8.
  virtual void recycle(Rgba8Image /*image*/) {}
};

/// The rasterizer on the CPU. It keeps the buffers of the last frame, whose pages need not be mapped again.
std::unique_ptr<Backend> make_cpu_backend();

}  // namespace zoneplate
#pragma GCC visibility pop
