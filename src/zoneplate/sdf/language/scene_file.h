// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/sdf/draw.h"

namespace zoneplate::sdf {

/// A scene of shapes as its file describes it. One unit is one pixel, unless the drawing is scaled.
struct SceneFile {
  int width = 0, height = 0;  ///< of the canvas; 0: not given
  Linear background{1, 1, 1, 1};
  Drawing drawing;
  std::vector<ShapePtr> shapes{};  ///< of the layers, if they are kept
  Bounds bounds{};                 ///< of all layers that have finite bounds
};

struct SceneFileOptions {
  bool keeps_shapes = false;
  /// The outline of a line of text of this size, with its baseline's start at the origin; none: `text` is an error.
  std::function<Outline(std::string_view text, double size)> text_outline{};
};

/// Reads a scene: JSON if its first character is {, else the text language.
///
/// Errors    ErrorKind::Input with the file, line and column.
SceneFile read_scene_file(std::string_view text, std::string_view file, const SceneFileOptions& options = {});

/// A shape or operation of the languages, for help.
struct ShapeWord {
  std::string_view name, parameters, summary;
};
std::span<const ShapeWord> shape_words();

}  // namespace zoneplate::sdf
