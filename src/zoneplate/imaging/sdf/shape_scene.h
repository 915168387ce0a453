// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/sdf/language/scene_file.h"

namespace zoneplate {

/// What operations have in common that take a scene of shapes.
struct ShapeSceneOptions : SignalOptions {
  std::optional<int2> size;
  double scale = 1;
  std::string font;  ///< a file; empty: DejaVu Sans
};

/// The outlines of `text` in scenes; the font is read when the first text needs it.
std::function<sdf::Outline(std::string_view, double)> text_outlines(const ShapeSceneOptions& args);

/// Reads the scene: a file, or - for stdin.
///
/// Errors    ErrorKind::Input, also for a file of more than 256 MiB.
sdf::SceneFile load_shape_scene(const std::string& operand, const sdf::SceneFileOptions& options, Delivery& out);

/// The pixels of the scene's canvas, or of its shapes with a margin; scaled, or fitted to the chosen size.
///
/// Errors    ErrorKind::Input for a scene without a canvas and without a finite shape; ErrorKind::Usage for an image of
///           more pixels than the limit, or than 32768 per side.
sdf::Raster raster_of(const sdf::SceneFile& scene, const ShapeSceneOptions& args, const std::string& operand);

}  // namespace zoneplate
