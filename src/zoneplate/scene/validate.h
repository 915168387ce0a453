#pragma once

#include <optional>
#include <string>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The first thing in which a scene breaks what scene.h and the headers of its parts promise; nothing if it is sound.
///
/// Loaders make sound scenes only. A scene that comes from another process is checked with this before it is used:
/// then every index is in range, every number finite and within what the renderer takes.
/// Cost      linear in vertices, indices and instances.
std::optional<std::string> find_invalid(const Scene& scene);

}  // namespace zoneplate
