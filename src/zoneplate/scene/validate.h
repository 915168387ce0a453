// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The first violation of the requirements of scene.h and the headers of its parts; nothing for a valid scene.
///
/// Loaders only return valid scenes. A scene from another process is validated before use: then every index is in
/// range, and every number is finite and within the renderer's limits.
/// Cost      linear in vertices, indices and instances.
std::optional<std::string> find_invalid(const Scene& scene);

}  // namespace zoneplate
