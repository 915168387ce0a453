// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// ByteSink writes and ByteSource reads the given number of bytes.
using ByteSink = std::function<void(const void*, std::size_t)>;
using ByteSource = std::function<void(void*, std::size_t)>;

/// Serializes a scene for another process of the same program. This is not a file format: it may change at any time.
void write_scene(const Scene& scene, const ByteSink& sink);

/// Reads the bytes of `write_scene`, which are not trusted.
///
/// Errors    ErrorKind::Input naming the budget's file: bytes that are not a scene, an invalid scene
///           (scene/validate.h), more than the budget.
Scene read_scene(const ByteSource& source, ImportBudget& budget);

}  // namespace zoneplate
