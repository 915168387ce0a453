#pragma once

#include <optional>
#include <string>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The first thing in which a scene breaks what scene.h, mesh.h and material.h promise of it; nothing if it is sound.
///
/// Loaders make sound scenes only; a scene that comes from another process is looked through before it is used.
std::optional<std::string> find_flaw(const Scene& scene);

}  // namespace zoneplate
