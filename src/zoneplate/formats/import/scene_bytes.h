#pragma once

#include <cstddef>
#include <functional>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Passes on, or fetches, so many bytes.
using ByteSink = std::function<void(const void*, std::size_t)>;
using ByteSource = std::function<void(void*, std::size_t)>;

/// A scene on its way from one process to another of the same program: no file format, it may change any day.
void write_scene(const Scene& scene, const ByteSink& sink);

/// What `write_scene` wrote. Whoever wrote it is not trusted.
///
/// Errors    ErrorKind::Input naming the budget's file: bytes that are no scene, a scene that is not sound
/// (scene/validate.h), more
///           than the budget.
Scene read_scene(const ByteSource& source, ImportBudget& budget);

}  // namespace zoneplate
