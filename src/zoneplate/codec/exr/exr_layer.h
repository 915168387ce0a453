// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/codec/exr/exr_header.h"

namespace zoneplate {

/// An image among the channels of an OpenEXR file: a layer of a part.
struct ExrLayer {
  enum class Kind {
    Colors,  ///< channels R, G, B and A, or such of other names
    Grey,    ///< the one channel is that of all colours
    Chroma,  ///< luminance and chroma: RY, Y, BY and A
  };
  int part = 0;
  std::string name;    ///< of its part, where the file has several, and of its channels: "beauty", "ViewLayer.Combined"
  std::string prefix;  ///< of its channels, with the full stop: "ViewLayer.Combined."
  Kind kind = Kind::Colors;
  bool has_colors = true;               ///< and no other data, as a depth or a normal has
  std::array<std::string, 4> channels;  ///< full names in place of red, green, blue and alpha; empty: it has none

  /// True for what every viewer shows: R, G, B or Y without a prefix, in the first part.
  bool is_main() const { return part == 0 && prefix.empty() && has_colors; }
};

/// The layers of a file, in its order. A layer is the channels of a part with a common prefix: R, G, B and A in either
/// case, or Y with RY and BY, as colours; others, such as X, Y and Z, in this order as red, green, blue and alpha.
/// Other channels beside colours, and those without a prefix in a file of one part, are a layer each.
std::vector<ExrLayer> exr_layers(std::span<const ExrPart> parts);

/// Chooses a layer by its name, which may also be that of its part, that of its channels without the part, the last
/// component of these, or that of a single channel.
///
/// An empty name chooses the first colours without a prefix; or the only layer of colours, or one that is named
/// Combined, beauty, RGBA, ... in either case; or the only layer.
/// Errors    ErrorKind::Usage, with `file` in front and the layers, if none or several have the name; ErrorKind::Input
///           likewise for an empty name.
ExrLayer choose_exr_layer(std::span<const ExrPart> parts, std::string_view name, const std::string& file);

/// The names of layers, for messages.
std::string listed_exr_layers(std::span<const ExrLayer> layers);

}  // namespace zoneplate
