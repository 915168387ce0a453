// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/ray/trace.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

class TextureSet;

/// The shadow casters of a scene, one for each instance; those of lines and points have no triangles. They refer to the
/// scene.
std::vector<ShadowCaster> make_casters(const Scene& scene);

/// The opacity of a scene's translucent casters: where an alpha-tested surface is present 1, else 0; of a blended
/// surface its alpha, times what it does not transmit (KHR_materials_transmission). Textures are looked up in level 0.
class CasterOpacity {
 public:
  /// Requires  the scene and its textures outlive this object.
  CasterOpacity(const Scene& scene, const TextureSet& textures) : scene_(scene), textures_(textures) {}

  /// Requires  this object outlives what it returns.
  OpacityOfHits of_hits() const {
    return {[](const void* self, const RayHit& hit) { return static_cast<const CasterOpacity*>(self)->at(hit); }, this};
  }

 private:
  float at(const RayHit& hit) const;

  const Scene& scene_;
  const TextureSet& textures_;
};

}  // namespace zoneplate
